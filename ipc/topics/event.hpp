// An event: a code, a cycle and two numbers. Texts for people are in ipc/topics/text.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

enum class EventCode : std::uint16_t {
    none,
    loop_started,
    state_changed,   // a: old RunState, b: new RunState
    fault_latched,   // a: RunReason, b: measured value, detail: 1 + hand whose device caused it; 0: no device
    overrun,         // a: overrun in microseconds, b: overruns so far
    force_limited,   // a: requested N, b: limit N
    torque_limited,  // a: requested N m, b: limit N m
    slew_limited,    // a: requested N per cycle, b: limit
    gui_attached,    // a: generation
    gui_detached,
    gui_silent,     // a: heartbeat age in ms
    command_done,   // a: CommandKind, b: CommandResult
    level_changed,  // a: index in LevelsTopic::path, b: new level, detail: LevelReason
    input_refused,  // a: count so far
    model_swapped,
    hand_present,
    hand_left,
    stopping,             // a: signal number; -1: the run time is over
    device_watchdog,      // a: ms since the previous cycle; the device switched its amplifier off
    torque_slew_limited,  // a: requested N m per cycle, b: limit
    body_selected,        // a: id, b: points of its finest level
    bodies_changed,       // a: bodies now, b: options (DockingOption)
    lines_changed,        // a: LinesShown, b: RunReason of the present or last stop
    device_notice,        // a: DeviceNotice, b: hand
};

struct EventTopic {
    static constexpr TopicInfo kInfo{.name = "event", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint16_t code;         // EventCode
    std::uint16_t detail;       // for codes with a detail; otherwise zero
    std::uint16_t reserved[2];  // zero
    double a;
    double b;
};
static_assert(std::is_trivially_copyable_v<EventTopic> && sizeof(EventTopic) == 40);

// Bits of TraceTopic::status, if the first hand drills bone.
enum TraceFlag : std::uint32_t {
    kTraceBurrTurns = 1U << 16,
    kTraceCuts = 1U << 17,  // bone was removed in this cycle
    kTraceHeldIn =
        1U << 18,  // bone on all sides of the burr: its push is shorter than that of the published equation
};

// One servo cycle, for traces, the flight recorder and plots.
struct TraceTopic {
    static constexpr TopicInfo kInfo{.name = "trace", .version = 3, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::int32_t lateness_ns;
    std::int32_t cost_ns;   // whole cycle
    std::int32_t model_ns;  // the force model's step
    float level;            // of the haptic path
    float pos_world_m[3];
    float force_world_n[3];
    float torque_world_n_m[3];
    std::uint32_t status;  // RunState in bits 0-7, StepStatus in bits 8-15, TraceFlag
    float model_error_n;   // bound of the error of the reduced force, in this step
    std::uint32_t items;   // points summed in this step; fewer than at the level if older sums were used
};
static_assert(std::is_trivially_copyable_v<TraceTopic> && sizeof(TraceTopic) == 80);

}  // namespace tact
