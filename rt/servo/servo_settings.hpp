// Settings of the servo loop.
//
// Thread    set at start-up; constant afterwards
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

// A path of the display: its knob, and the members of the visual process's report that describe it.
struct VisualPath {
    KnobSpec knob;
    std::uint32_t HousekeepingReport::*items_max;
    std::uint32_t HousekeepingReport::*drawn;
    double HousekeepingReport::*cost_s;
};

// Selects the switch that turns a hand's tool on.
enum class DriveSwitch : std::uint8_t {
    button,  // kDriveButton of the hand's device
    line,    // an input of the safety inputs' adapter (hal/api/lines.hpp): on or off
    always,  // while the force is on
};

struct DriveInput {
    DriveSwitch by = DriveSwitch::button;
    std::uint8_t line = 0;  // LineInput
};

struct ServoSettings {
    Duration period = std::chrono::milliseconds(1);
    bool free_running = false;
    Duration model_max = std::chrono::microseconds(600);  // deadline of a step, beneath its level
    bool model_deadline = true;                           // false for a clock that is not the machine's
    double force_scale = 1.0;
    double damping_n_s_m = 0.0;  // of the coupling, against the tool's velocity
    // Of hand and arm; they bound the stiffness that is stable at a delay. In rotation: that damping at the 3 cm between
    // fingers and the stylus' centre.
    double hand_damping_n_s_m = 3.0;
    double hand_turn_damping_n_m_s_rad = 0.003;
    Pose T_world_dev;
    // At least one; outlives the servo. The first has index kDisplayPathIndex, the others follow kForcePathIndex.
    std::span<const VisualPath> visual_paths;
    WatchdogSettings watchdogs;
    ChainSettings chain;
    GovernorSettings governor;
    Duration governor_interval = std::chrono::milliseconds(100);
    Duration gui_silent = std::chrono::milliseconds(500);
    bool gui_silent_ramps = false;  // true: a silent GUI ramps the force out; false: it is only reported
    std::uint32_t dry_cycles = 4000;
    bool emulated = false;                                   // the device is emulated: no person holds it
    Duration lines_age_max = std::chrono::milliseconds(20);  // oldest valid sample of the safety inputs
};

struct HandParts {
    HapticDevice* device;
    ForceModel* model;
    DeviceInfo info;
    DriveInput drive = {};
};

// Recorded values of a replayed cycle that cannot be recomputed.
struct CycleScript {
    float level = 1.0F;                                     // level of the haptic path
    std::array<std::uint32_t, kHandsMax> deadline_check{};  // check that found the deadline passed; 0: none
};

}  // namespace tact
