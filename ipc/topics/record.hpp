// What a servo cycle was given and what came of it, in rings: enough to do every cycle again, to the bit.
//
// Writer   the servo thread. In each cycle first what came by mailbox, then each hand, then the cycle itself: who sees a
//          step in `cycles` finds the rest of it in the other rings, unless they lapped.
// Step     counts all cycles, the dry ones before the start too, from 1; it joins the rings.
// Reader   tact-record, which writes a file (ipc/record), and whoever replays one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

// A command after validation: kinds and indexes are in range, values and poses are finite.
struct ServoOrder {
    std::uint64_t sequence;  // of the command; 0: from the command line, not acknowledged
    double value;
    std::uint32_t kind;      // CommandKind
    std::uint32_t index;     // path or law
    std::uint32_t body = 0;  // an id, or a structure; only the model knows which there are
    std::uint32_t reserved = 0;
    double pos_model_m[3] = {0.0, 0.0, 0.0};
    double quat_model_body_xyzw[4] = {0.0, 0.0, 0.0, 1.0};  // of unit length
};

// What the servo is told of the visual process and of itself.
struct HousekeepingReport {
    std::int64_t gui_heartbeat_ns;  // when the GUI last reported; -1: never
    std::uint64_t gui_generation;
    std::uint64_t bad_input;
    std::uint64_t page_faults;  // of the servo thread, from /proc, since it asked
    double gui_fps;
    double gui_busy_s;
    std::uint64_t gui_frame;            // of the newest word
    std::uint64_t gui_levels_sequence;  // of the levels that this frame applied
    std::int64_t gui_taken_at_ns;
    double gui_work_s;  // of the frame, without its pause
    double gui_cpu_s;   // processor time since its start
    std::uint32_t gui_vertices;
    std::uint32_t gui_vertices_max;
    std::uint32_t gui_particles_max;
    std::uint32_t gui_attached;  // 0 or 1
    double gui_particles_s;      // of the frame, for moving and drawing them
};

enum CycleFlag : std::uint8_t {
    kCycleDry = 1U << 0,    // before the start, with the gate closed
    kCycleLines = 1U << 1,  // safety lines were looked at
};

struct CycleTopic {
    static constexpr TopicInfo kInfo{.name = "cycle", .version = 1, .writer = Writer::rt};
    static constexpr std::size_t kTimestampsMax = 5;
    std::uint64_t step;
    std::uint64_t cycle;                    // of the loop, from 1; of a dry one as counted then
    std::int64_t clock_ns[kTimestampsMax];  // what the clock said, each time that the servo looked
    std::int64_t now_ns;                    // the one that the cycle goes by
    std::int64_t lateness_ns;               // of its beginning
    std::int64_t cost_ns;                   // whole cycle
    std::int64_t model_ns;                  // the force models' steps
    float level;                            // of the haptic path
    float work_fraction;                    // of the level's work that may be done anew
    std::int64_t lines_taken_at_ns;         // safety lines as read, with kCycleLines
    std::uint64_t lines_sequence, lines_trips;
    std::uint8_t lines_state, lines_cause, lines_inputs, lines_outputs;
    std::uint8_t run_state, run_reason;  // RunState, RunReason, at the end of the cycle
    std::uint8_t flags;                  // CycleFlag
    std::uint8_t timestamps;             // how many of clock_ns there are
};
static_assert(std::is_trivially_copyable_v<CycleTopic> && sizeof(CycleTopic) == 128);

// One hand in one step.
struct HandTopic {
    static constexpr TopicInfo kInfo{.name = "hand", .version = 1, .writer = Writer::rt};
    std::uint64_t step;
    // As the device gave it (DeviceSample).
    std::int64_t taken_at_ns;
    std::uint64_t sequence;
    double pos_dev_m[3];
    double quat_dev_tool_xyzw[4];
    double velocity_dev_m_s[3];
    double angular_dev_rad_s[3];
    std::int64_t delay_ns;
    // What came of it.
    double force_world_n[3];  // as sent to the device, after the safety chain
    double torque_world_n_m[3];
    double force_model_world_n[3];  // as the force model wants it, before the safety chain
    double torque_model_world_n_m[3];
    float model_error_n;
    std::uint32_t items;  // felt
    std::uint32_t buttons;
    std::uint32_t
        deadline_check;  // the model's look at its deadline that found it passed, from 1; 0: none did
    std::uint8_t read_status, write_status;  // IoStatus
    std::uint8_t hand_present, device_state, notice;
    std::uint8_t step_status;  // StepStatus
    std::uint8_t at_wall;      // 1: a wall of the workspace pushes back
    std::uint8_t reserved;     // zero
};
static_assert(std::is_trivially_copyable_v<HandTopic> && sizeof(HandTopic) == 256);
static_assert(offsetof(HandTopic, force_world_n) == 136);

enum class MailboxKind : std::uint32_t {
    none,
    order,
    model_taken,    // a model that was built aside
    build_refused,  // none could be built
    stop,           // order.value: signal number; -1: the run's time was over
    drops,          // order.sequence: drops by the supervisor so far
};

// What the servo took from others, in the step in which it did.
struct MailboxTopic {
    static constexpr TopicInfo kInfo{.name = "mailbox", .version = 1, .writer = Writer::rt};
    std::uint64_t step;
    std::uint32_t kind;      // MailboxKind
    std::uint32_t reserved;  // zero
    ServoOrder order;
};
static_assert(std::is_trivially_copyable_v<MailboxTopic> && sizeof(MailboxTopic) == 104);

struct ReportTopic {
    static constexpr TopicInfo kInfo{.name = "report", .version = 1, .writer = Writer::rt};
    std::uint64_t step;
    HousekeepingReport said;
};
static_assert(std::is_trivially_copyable_v<ReportTopic> && sizeof(ReportTopic) == 120);

enum StartFlag : std::uint32_t {
    kStartEmulated = 1U << 0,  // no real device
    kStartLines = 1U << 1,     // safety lines are fitted
};

// A device, as it introduced itself.
struct StartDevice {
    char name[64];  // ends with 0
    double workspace_half_m[3];
    double force_n_max, force_n_continuous, torque_n_m_max, stiffness_n_m_max, position_step_m;
};

// How the loop began. Once, when its first cycle is about to come.
struct alignas(64) StartTopic {
    static constexpr TopicInfo kInfo{.name = "start", .version = 1, .writer = Writer::rt};
    std::int64_t started_at_ns;
    std::uint64_t dry_steps;  // cycles before
    std::int64_t period_ns;   // 0: free running
    std::uint32_t hands;
    std::uint32_t flags;  // StartFlag
    double pos_world_dev_m[3];
    double quat_world_dev_xyzw[4];
    StartDevice device[2];
    std::uint8_t reserved[40];  // zero
};
static_assert(std::is_trivially_copyable_v<StartTopic> && sizeof(StartTopic) == 384);

// How the controller was started, for whoever wants to start it again so. Written before the region is ready.
struct RunText {
    static constexpr TopicInfo kInfo{.name = "runtext", .version = 2, .writer = Writer::rt};
    static constexpr std::size_t kArgumentsMax = 4096, kConfigMax = 32768, kPosesMax = 65536;
    static constexpr std::uint32_t kTooLong = 0xFFFFFFFFU;  // as a count: there was more than fits
    std::uint32_t arguments_bytes;                          // each argument ends with 0
    std::uint32_t config_bytes, poses_bytes;                // 0: no such file
    std::uint32_t reserved;                                 // zero
    char arguments[kArgumentsMax];
    char config[kConfigMax];  // content of the file of --config
    char poses[kPosesMax];    // of --poses
    char program[64];         // the controller and its version; ends with 0
};
static_assert(std::is_trivially_copyable_v<RunText>);

}  // namespace tact
