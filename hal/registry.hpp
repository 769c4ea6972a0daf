// The one table of haptic device drivers. A new driver is a folder in hal/ and a row in registry.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "hal/api/haptic_device.hpp"
#include "hal/arm/arm_table.hpp"
#include "hal/sim/sim_device.hpp"
#include "ipc/base/fifo.hpp"

namespace tact {

struct DeviceSettings {
    std::string driver = "sim";
    SimSettings sim;
    ArmParameterSet arm;                                 // of real arms
    std::string serial;                                  // of a real device; empty: the only one there is
    Duration state_hold = std::chrono::milliseconds(3);  // a real device's newest state is good for so long
    int pump_priority = kPumpPriority;  // FIFO, of the thread that owns a real device's bus; 0: ordinary
    void (*say)(const char* text) =
        nullptr;              // while open() waits or goes on with less; null: on standard error
    std::string process_log;  // of "sim-process": file for its changes of state; empty: none
    std::string hd_library;   // of "openhaptics": path of libHD.so; empty: searched
    std::string hd_device;    // and the arm's name in the maker's set-up program; empty: the default one
    std::string firmware;     // of "falcon": file that its owner has; empty: it has to run already
};

struct DeviceEntry {
    const char* name;
    const char* what;
    bool emulated;  // nobody's hand is on it
    std::unique_ptr<HapticDevice> (*make)(const DeviceSettings&);
};

[[nodiscard]] std::span<const DeviceEntry> device_drivers();
// Throws StartupError that names the drivers there are.
[[nodiscard]] const DeviceEntry& device_driver(const std::string& name);

}  // namespace tact
