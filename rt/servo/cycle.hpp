// What one servo cycle knows. Lies in the arena; every stage of rt/servo/servo.cpp reads and writes it.
#pragma once

#include <array>
#include <cstdint>

#include "hal/api/haptic_device.hpp"
#include "hal/api/lines.hpp"
#include "ipc/topics/command.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/force/force_model.hpp"
#include "rt/safety/output_chain.hpp"
#include "rt/safety/smooth_gain.hpp"
#include "rt/safety/state_machine.hpp"
#include "rt/safety/watchdogs.hpp"
#include "rt/servo/mailbox.hpp"

namespace tact {

struct HandCycle {
    HapticDevice* device = nullptr;
    ForceModel* model = nullptr;
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
    Wrench shown_world;                // as sent to the device
    std::array<Instant, 8> said_at{};  // per ChainAct: when an event last said so
    DeviceNotice said = DeviceNotice::none;
};

// Safety lines, where there are any.
struct LinesCycle {
    LinesSample sample;
    LinesCommand command;
    RunReason stops = RunReason::none;  // force and arming
    Duration age{0};
    std::uint64_t trips_at_arming = 0;
};

// What is driven in this cycle.
struct DrivesCycle {
    double burr_rad_s = 0.0;
    bool irrigation = false, suction = false;
};

struct CycleState {
    std::uint64_t cycle = 0;
    std::uint64_t step = 0;                                       // cycles, those before the start too
    std::array<Instant, CycleTopic::kTimestampsMax> timestamp{};  // at the clock, in this cycle
    std::uint8_t timestamps = 0;
    Instant planned{}, now{}, before{};
    Duration lateness{0}, dt{0}, cost{0}, model_cost{0};
    Duration behind{0};  // how far past the next one's instant the cycle before this one ended
    Budget budget{};
    double recomputed_fraction = 1.0;  // of the models' work, what was done anew; a mean over the hands
    bool overran = false;              // the cycle before this one
    std::uint64_t out_of_time = 0;
    HousekeepingReport housekeeping{};
    ServoOrder order{};  // of this cycle that concerns the state; kind none: nothing asked
    RunEvents events;
    RunStatus run;
    Trip trip;
    LinesCycle lines;
    DrivesCycle drives;
    std::uint64_t drops_seen = 0;  // by the supervisor
    std::uint32_t hands = 0;
    HandCycle hand[kHandsMax];
};

}  // namespace tact
