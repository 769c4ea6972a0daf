// What the servo loop is told at its start.
//
// Thread    start-up; never changes afterwards
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/api/haptic_device.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/knob.hpp"
#include "ipc/topics/record.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/force_model.hpp"
#include "rt/govern/governor.hpp"
#include "rt/safety/output_chain.hpp"
#include "rt/safety/watchdogs.hpp"

namespace tact {

// A path of the display: its knob, and what the visual process reports of it.
struct VisualPath {
    KnobSpec knob;
    std::uint32_t HousekeepingReport::*items_max;
    double HousekeepingReport::*cost_s;
};

// What switches the tool of a hand on.
enum class DriveSwitch : std::uint8_t {
    button,  // kDriveButton of the hand's own device
    line,    // an input of the safety lines' adapter (hal/api/lines.hpp): on or off
    always,  // while the force is on
};

struct DriveInput {
    DriveSwitch by = DriveSwitch::button;
    std::uint8_t line = 0;  // LineInput
};

struct ServoSettings {
    Duration period = std::chrono::milliseconds(1);
    bool free_running = false;
    Duration model_max = std::chrono::microseconds(600);  // of the model's step; the net beneath its level
    bool model_deadline = true;                           // false with a clock that is not the machine's
    double force_scale = 1.0;
    double damping_n_s_m = 0.0;       // of the coupling, against the tool's velocity
    double hand_damping_n_s_m = 3.0;  // of hand and arm: bounds the stiffness that is stable at a delay
    Pose T_world_dev;
    // At least one; outlives the servo. The first is at kDisplayPathIndex, the others follow kForcePathIndex.
    std::span<const VisualPath> visual_paths;
    WatchdogSettings watchdogs;
    ChainSettings chain;
    GovernorSettings governor;
    Duration governor_interval = std::chrono::milliseconds(100);
    Duration gui_silent = std::chrono::milliseconds(500);
    bool gui_silent_ramps = false;  // else it is only reported
    std::uint32_t dry_cycles = 1000;
    bool emulated = false;                                   // nobody's hand is on the device
    Duration lines_age_max = std::chrono::milliseconds(20);  // of their newest sample
};

struct HandParts {
    HapticDevice* device;
    ForceModel* model;
    DeviceInfo info;
    DriveInput drive = {};
};

// Of a cycle that is repeated: what cannot be asked twice.
struct CycleScript {
    float level = 1.0F;                                     // of the haptic path
    std::array<std::uint32_t, kHandsMax> deadline_check{};  // that found the deadline passed; 0: none
};

}  // namespace tact
