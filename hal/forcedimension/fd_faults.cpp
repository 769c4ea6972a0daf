#include "hal/forcedimension/fd_faults.hpp"

#include <array>

#include "hal/forcedimension/fd_api.hpp"

namespace tact::fd {

namespace {

// Indexed by FaultKind.
constexpr std::array<FaultMeaning, kFaultKinds> kFdMeanings{{
    {FaultKind::none, DeviceNotice::none, "no error", ""},
    {FaultKind::link, DeviceNotice::gone, "there is no communication with the device",
     "check its USB cable and power supply; Tact finds it again, then re-arm"},
    {FaultKind::busy, DeviceNotice::commands_not_taken, "another program uses the device",
     "end that program (HapticDesk, HapticInit, a second tact-rt), then start again"},
    {FaultKind::device, DeviceNotice::amplifier_off, "the device's controller reports an error",
     "switch the device off and on, initialize it, and start again"},
    {FaultKind::refused, DeviceNotice::commands_not_taken, "the library rejected a call",
     "set device.fd_library to the library of a newer Force Dimension SDK; HapticDesk shows whether the "
     "device works"},
    {FaultKind::button, DeviceNotice::safety_open,
     "the force button of the device, or the sensor in its handle, switched the force off",
     "press the force button of the device or hold its handle, then re-arm"},
    {FaultKind::velocity, DeviceNotice::amplifier_off,
     "the device's own velocity limit switched the force off",
     "move the handle more slowly, then re-arm; if it happens again, lower safety.force_n_max"},
    {FaultKind::firmware, DeviceNotice::watchdog_tripped,
     "the device's own watchdog switched the force off: it received no force for 10 ms",
     "reduce the load of the processor, set device.pump_priority, then re-arm"},
    {FaultKind::force_off, DeviceNotice::amplifier_off, "the device switched its force off",
     "check the device's power supply and force button, then re-arm"},
    {FaultKind::not_initialized, DeviceNotice::not_initialized,
     "the device is not initialized: it does not know the zero of its encoders",
     "run HapticInit of the Force Dimension SDK, or set device.fd_initialize = true and let go of the arm, "
     "which then moves by itself at the start"},
}};

}  // namespace

const FaultMeaning& meaning(FaultKind kind) noexcept {
    const auto at = static_cast<std::size_t>(kind);
    return kFdMeanings[at < kFaultKinds ? at : static_cast<std::size_t>(FaultKind::refused)];
}

FaultKind fault_of_error(int code) noexcept {
    switch (code) {
        case kErrorCom:
        case kErrorNoDriver:
        case kErrorNoDevice:
        case kErrorTimeout:
        case kErrorNotReady:
            return FaultKind::link;
        case kErrorBusy:
        case kErrorInUse:
            return FaultKind::busy;
        case kErrorGeometry:
        case kErrorRedundantFail:
            return FaultKind::device;
        default:
            return FaultKind::refused;
    }
}

FaultKind fault_of_force_off(int cause) noexcept {
    switch (cause) {
        case kForceOffButton:
        case kForceOffDeadMan:
            return FaultKind::button;
        case kForceOffVelocity:
            return FaultKind::velocity;
        case kForceOffWatchdog:
            return FaultKind::firmware;
        case kForceOffUsb:
            return FaultKind::link;
        default:
            return FaultKind::force_off;
    }
}

}  // namespace tact::fd
