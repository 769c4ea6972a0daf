// Table of the haptic device drivers. A new driver is a folder in hal/ and a row in registry.cpp.
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
    ArmParameterSet arm;                                 // for real arms
    std::string serial;                                  // of a real device; empty: the only one connected
    Duration state_hold = std::chrono::milliseconds(3);  // validity of a real device's newest state
    int pump_priority = kPumpPriority;  // FIFO, of the thread that owns a real device's bus; 0: ordinary
    void (*say)(const char* text) =
        nullptr;                 // reports progress and reduced operation in open(); null: standard error
    std::string process_log;     // "sim-process": file for its changes of state; empty: none
    std::string hd_library;      // "openhaptics": path of libHD.so; empty: searched
    std::string hd_device;       // "openhaptics": the arm's name in its set-up program; empty: default
    std::string fd_library;      // "forcedimension": path of libdrd.so or libdhd.so; empty: searched
    bool fd_initialize = false;  // "forcedimension": an arm that is not initialized moves by itself in open()
    bool fd_gravity = false;     // "forcedimension": the library holds the weight of the arm
    std::uint16_t inverse_port = 10001;  // "inverse3": WebSocket port of the Inverse Service on this machine
    std::string firmware;  // "falcon": the user's firmware file; empty: the firmware must already run
};

struct DeviceEntry {
    const char* name;
    const char* what;
    bool emulated;  // no person holds it
    std::unique_ptr<HapticDevice> (*make)(const DeviceSettings&);
};

[[nodiscard]] std::span<const DeviceEntry> device_drivers();
// Throws StartupError that lists the known drivers.
[[nodiscard]] const DeviceEntry& device_driver(const std::string& name);

}  // namespace tact
