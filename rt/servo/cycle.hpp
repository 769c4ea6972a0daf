// State of the servo loop: the data of one cycle and the data that stages keep between cycles.
//
// Use       each stage (rt/servo/stage_*.hpp) is a function over CycleState; Servo calls the stages in order. Stages
//           keep no other state: equal states and equal inputs give equal results.
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
#include "rt/govern/level_fit.hpp"
#include "rt/govern/rate_hold.hpp"
#include "rt/safety/output_chain.hpp"
#include "rt/safety/smooth_gain.hpp"
#include "rt/safety/state_machine.hpp"
#include "rt/safety/watchdogs.hpp"
#include "rt/servo/armed_metrics.hpp"
#include "rt/servo/mailbox.hpp"
#include "rt/servo/servo_settings.hpp"
#include "rt/servo/statistics.hpp"

namespace tact {

struct HandCycle {
    HapticDevice* device = nullptr;
    ForceModel* model = nullptr;
    DriveInput drive;
    bool torque = false;  // the device can apply torque
    DeviceSample sample;
    IoStatus read_status = IoStatus::ok;
    IoStatus write_status = IoStatus::ok;
    bool sample_usable = false;
    Duration age_most{0};  // oldest sample since the devices were last published
    ToolState tool;
    StepResult step;
    DeadlineChecks deadline;          // checks of the deadline during that step
    ModelStiffness stiffness;         // of the model at the device, before its gain
    SmoothGain field, walls, damper;  // gains that keep each stable at the present delay
    Wrench wanted_world;              // after shaping
    OutputChain chain;
    ChainOutput out;
    Wrench shown_world;                    // sent to the device
    std::array<Instant, 8> reported_at{};  // per ChainAct: time of its last event
    DeviceNotice reported = DeviceNotice::none;
};

// Safety inputs, where fitted.
struct LinesCycle {
    bool fitted = false;
    LinesSample sample;
    LinesCommand command;
    RunReason stops = RunReason::none;  // why the lines stop the force and bar arming
    Duration age{0};
    std::uint64_t trips_at_arming = 0;
    std::uint64_t drops_seen = 0;  // supervisor drops handled so far
};

// Orders and models from the mailbox.
struct MailboxCycle {
    RingCursor orders;
    ServoOrder refused_arm{};  // in this cycle, in favour of a disarm; kind none: there was none
    std::uint64_t reports_seen = 0;
    std::uint64_t gui_generation = 0;
    bool gui_attached = false, gui_silent = false;
    bool building = false;                 // another thread builds a model
    std::uint16_t governed_structure = 0;  // structure whose knob the governor uses
};

// Reports sent and reports due.
struct ReportCycle {
    std::uint64_t events = 0;  // published so far
    CommandResult last_result = CommandResult::none;
    std::uint64_t last_sequence = 0;
    CommandResult state_result = CommandResult::none;  // of the last arm or disarm
    std::uint64_t state_sequence = 0;
    bool health_due = false;
    Instant health_at{}, overrun_reported_at{};
    std::int64_t overrun_at_ns = 0;  // last overrun
    std::uint64_t page_faults = 0;
    std::uint32_t schedule_flags = 0;
    std::uint64_t levels_sequence = 0;
    std::array<std::int64_t, kPathsMax> level_changed_at_ns{};
    std::array<std::uint32_t, kPathsMax> items_max{};  // items per path, as last published
};

// The governor's present interval and its measurements of the work.
struct GovernCycle {
    Instant begun_at{};
    std::uint64_t cycles = 0, overruns = 0;
    Duration cost{0}, model_cost{0}, rest{0};
    double recomputed = 0.0;   // sum over the updates of the recomputed fraction of the model's work
    double asked = 0.0;        // the same of the fraction that was asked for
    double law_rate_hz = 0.0;  // rate that the law received for the last interval
    double model_cost_s = 0.0;
    DisplayWatch display;
    RateHold hold;                                   // inner loop of the governor, free running only
    double whole_model_s = 0.0, whole_cost_s = 0.0;  // recent steps that did all of their work
    LevelFit fit;                                    // of the haptic path
    double other_s = 0.0;                            // cost of the previous cycle without the models
    float level_max = 1.0F;  // highest level at which the slow update keeps its period
};

// Largest stiffness and damping that are stable at the delay of the last second.
struct DelayBounds {
    double stiffness_n_m = 0.0, damping_n_s_m = 0.0, torque_n_m_rad = 0.0;
};

struct CycleState {
    // Throws StartupError if the model's knob is impossible.
    CycleState(const ServoSettings& settings, std::span<const HandParts> parts, Instant now);

    std::uint64_t cycle = 0;
    std::uint64_t step = 0;  // cycles, including those before the start
    bool dry = false;        // before the start, with the gate closed
    bool stopping = false, finished = false;
    std::array<Instant, CycleTopic::kTimestampsMax> timestamp{};  // clock readings in this cycle
    std::uint8_t timestamps = 0;
    Instant planned{}, now{}, before{};
    // For the devices: dry cycles take no time of emulated ones, whose hand nothing holds then.
    Instant device_now{};
    Duration lateness{0}, dt{0}, cost{0}, model_cost{0};
    Duration behind{0};  // from the planned start of this cycle to the end of the previous one
    Budget budget{};
    double recomputed_fraction = 1.0;  // of the models' work; mean over the hands
    bool overran = false;              // the previous cycle overran
    bool deadline_missed = false;      // the models ended after their deadline in this cycle
    HousekeepingReport housekeeping{};
    ServoOrder order{};  // this cycle's order to the state machine; kind none: no order
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
    ArmedMetrics armed;
    std::uint32_t hands = 0;
    HandCycle hand[kHandsMax];
};

}  // namespace tact
