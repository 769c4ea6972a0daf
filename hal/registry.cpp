#include "hal/registry.hpp"

#include <algorithm>
#include <array>

#include "hal/falcon/falcon.hpp"
#include "hal/forcedimension/force_dimension.hpp"
#include "hal/haply/inverse3.hpp"
#include "hal/openhaptics/open_haptics.hpp"
#include "hal/phantom/phantom_usb.hpp"
#include "hal/polhem/hidraw_port.hpp"
#include "hal/polhem/polhem_bus.hpp"
#include "hal/sim/process_device.hpp"
#include "ipc/base/error.hpp"

namespace tact {

namespace {

std::unique_ptr<HapticDevice> make_sim(const DeviceSettings& s) { return std::make_unique<SimDevice>(s.sim); }

std::unique_ptr<HapticDevice> make_sim_process(const DeviceSettings& s) {
    return std::make_unique<ProcessDevice>(s.sim, s.process_log);
}

std::unique_ptr<HapticDevice> make_phantom_usb(const DeviceSettings& s) {
    return std::make_unique<PhantomUsb>(
        PhantomUsbSettings{.serial = s.serial,
                           .arm = s.arm,
                           .hold_max = s.state_hold,
                           .watchdog_max = std::max(s.sim.watchdog, phantom::UsbPump::kWatchdogMax),
                           .pump_priority = s.pump_priority,
                           .say = s.say});
}

std::unique_ptr<HapticDevice> make_open_haptics(const DeviceSettings& s) {
    OpenHapticsSettings settings;
    settings.library = s.hd_library;
    settings.device = s.hd_device;
    return std::make_unique<OpenHaptics>(settings);
}

std::unique_ptr<HapticDevice> make_force_dimension(const DeviceSettings& s) {
    ForceDimensionSettings settings;
    settings.library = s.fd_library;
    settings.serial = s.serial;
    settings.initialize = s.fd_initialize;
    settings.gravity = s.fd_gravity;
    settings.pump_priority = s.pump_priority;
    settings.say = s.say;
    return std::make_unique<ForceDimension>(settings);
}

std::unique_ptr<HapticDevice> make_inverse3(const DeviceSettings& s) {
    Inverse3Settings settings;
    settings.serial = s.serial;
    settings.port = s.inverse_port;
    settings.pump_priority = s.pump_priority;
    settings.say = s.say;
    return std::make_unique<Inverse3>(settings);
}

std::unique_ptr<HapticDevice> make_polhem(const DeviceSettings& s) {
    return std::make_unique<PhantomUsb>(
        PhantomUsbSettings{.serial = s.serial,
                           .arm = s.arm,
                           .hold_max = s.state_hold,
                           .pump_priority = s.pump_priority,
                           .say = s.say},
        std::make_unique<polhem::PolhemBus>(std::make_unique<polhem::HidrawPort>()));
}

std::unique_ptr<HapticDevice> make_falcon(const DeviceSettings& s) {
    FalconSettings settings;
    settings.serial = s.serial;
    settings.firmware = s.firmware;
    settings.hold_max = s.state_hold;
    settings.pump_priority = s.pump_priority;
    settings.say = s.say;
    return std::make_unique<Falcon>(settings);
}

constexpr std::array kDevices{
    DeviceEntry{"sim", "emulated Phantom and hand, in lockstep with the servo", true, &make_sim},
    DeviceEntry{"sim-process", "the same in a separate process that outlives the controller", true,
                &make_sim_process},
    DeviceEntry{"phantom-usb", "a Phantom arm on an amplifier board, over USB; see [arm]", false,
                &make_phantom_usb},
    DeviceEntry{"openhaptics", "Touch, Omni, Desktop or Premium through the manufacturer's library libHD.so",
                false, &make_open_haptics},
    DeviceEntry{
        "forcedimension",
        "omega, delta, sigma or lambda of Force Dimension, through the manufacturer's library libdrd.so; "
        "not yet tested on hardware",
        false, &make_force_dimension},
    DeviceEntry{"inverse3",
                "Inverse3 or Minverse of Haply, through its Inverse Service; not yet tested on hardware",
                false, &make_inverse3},
    DeviceEntry{"polhem", "Haptikfabriken or Polhem arm, over hidraw; see [arm]; not yet tested on hardware",
                false, &make_polhem},
    DeviceEntry{"falcon", "Novint Falcon, with a firmware file from the user; not yet tested on hardware",
                false, &make_falcon},
};

}  // namespace

std::span<const DeviceEntry> device_drivers() { return kDevices; }

const DeviceEntry& device_driver(const std::string& name) {
    std::string known;
    for (const DeviceEntry& d : kDevices) {
        if (name == d.name) return d;
        known += (known.empty() ? "" : ", ") + std::string(d.name);
    }
    throw StartupError("device driver \"" + name + "\"", "no driver has this name",
                       "set device.driver to one of: " + known);
}

}  // namespace tact
