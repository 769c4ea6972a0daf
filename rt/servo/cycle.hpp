// What one servo cycle knows, and what the stages remember from one cycle to the next.
//
// Use       each stage (rt/servo/stage_*.hpp) is a function over it; Servo calls them in order. Its memory is this
//           struct alone: two states that are equal go on equally, given the same inputs.
// Thread    servo
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/api/haptic_device.hpp"
#include "hal/api/lines.hpp"
#include "ipc/base/pacer.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/force_model.hpp"
#include "rt/govern/display_watch.hpp"
#include "rt/govern/governor.hpp"
#include "rt/govern/rate_hold.hpp"
#include "rt/safety/output_chain.hpp"
#include "rt/safety/smooth_gain.hpp"
#include "rt/safety/state_machine.hpp"
#include "rt/safety/watchdogs.hpp"
#include "rt/servo/mailbox.hpp"
#include "rt/servo/servo_settings.hpp"
#include "rt/servo/statistics.hpp"

namespace tact {

struct HandCycle {
    HapticDevice* device = nullptr;
    ForceModel* model = nullptr;
    DriveInput drive;
    bool torque = false;  // the device can show torque
    DeviceSample sample;
    IoStatus read_status = IoStatus::ok;
    IoStatus write_status = IoStatus::ok;
    bool sample_usable = false;
    Duration age_most{0};  // of a sample, since the devices were last published
    ToolState tool;
    StepResult step;
    DeadlineChecks deadline;          // of that step
    SmoothGain field, walls, damper;  // of what is felt of them at today's delay
    Wrench wanted_world;              // after shaping
    OutputChain chain;
    ChainOutput out;
    Wrench shown_world;                    // as sent to the device
    std::array<Instant, 8> reported_at{};  // per ChainAct: its last event
    DeviceNotice reported = DeviceNotice::none;
};

// Safety lines, where there are any.
struct LinesCycle {
    bool fitted = false;
    LinesSample sample;
    LinesCommand command;
    RunReason stops = RunReason::none;  // force and arming
    Duration age{0};
    std::uint64_t trips_at_arming = 0;
    std::uint64_t drops_seen = 0;  // by the supervisor
};

// Orders and models that come by the mailbox.
struct MailboxCycle {
    RingCursor orders;
    ServoOrder refused_arm{};  // in this cycle, in favour of a disarm; kind none: there was none
    std::uint64_t reports_seen = 0;
    std::uint64_t gui_generation = 0;
    bool gui_attached = false, gui_silent = false;
    bool building = false;                 // a model is being built aside
    std::uint16_t governed_structure = 0;  // whose knob the governor has
};

// What was reported, and what is due.
struct ReportCycle {
    std::uint64_t events = 0;  // published so far
    CommandResult last_result = CommandResult::none;
    std::uint64_t last_sequence = 0;
    CommandResult state_result = CommandResult::none;  // of the last arm or disarm
    std::uint64_t state_sequence = 0;
    bool health_due = false;
    Instant health_at{}, overrun_reported_at{};
    std::int64_t overrun_at_ns = 0;  // the last one
    std::uint64_t page_faults = 0;
    std::uint32_t schedule_flags = 0;
    std::uint64_t levels_sequence = 0;
    std::array<std::uint32_t, kPathsMax> items_max{};  // of the paths, as last published
};

// The governor's running interval, and what it has to know of the work.
struct GovernCycle {
    Instant begun_at{};
    std::uint64_t cycles = 0, overruns = 0;
    Duration cost{0}, model_cost{0}, rest{0};
    double recomputed = 0.0;   // updates, each by how much of its model's work it did anew
    double law_rate_hz = 0.0;  // of the last interval, as the law had it
    double model_cost_s = 0.0;
    DisplayWatch display;
    RateHold hold;                                   // beneath the governor, where the loop runs freely
    double whole_model_s = 0.0, whole_cost_s = 0.0;  // of steps that did all of their work, lately
};

// Stable at the delay of the last second.
struct DelayBounds {
    double stiffness_n_m = 0.0, damping_n_s_m = 0.0;
};

struct CycleState {
    // Throws StartupError where the model's knob is impossible.
    CycleState(const ServoSettings& settings, std::span<const HandParts> parts, Instant now);

    std::uint64_t cycle = 0;
    std::uint64_t step = 0;  // cycles, those before the start too
    bool dry = false;        // before the start, with the gate closed
    bool stopping = false, finished = false;
    std::array<Instant, CycleTopic::kTimestampsMax> timestamp{};  // of the clock, in this cycle
    std::uint8_t timestamps = 0;
    Instant planned{}, now{}, before{};
    Duration lateness{0}, dt{0}, cost{0}, model_cost{0};
    Duration behind{0};  // from the planned start of this cycle to the end of the one before it
    Budget budget{};
    double recomputed_fraction = 1.0;  // of the models' work; a mean over the hands
    bool overran = false;              // the cycle before this one
    std::uint64_t out_of_time = 0;
    HousekeepingReport housekeeping{};
    ServoOrder order{};  // of this cycle that concerns the state; kind none: nothing asked
    RunEvents events;
    RunStatus run;
    Trip trip;
    DelayBounds bounds;

    LinesCycle lines;
    MailboxCycle mailbox;
    ReportCycle report;
    GovernCycle govern;
    Pacer pacer;
    Watchdogs watchdogs;
    Governor governor;
    ServoStatistics statistics;
    std::uint32_t hands = 0;
    HandCycle hand[kHandsMax];
};

}  // namespace tact
