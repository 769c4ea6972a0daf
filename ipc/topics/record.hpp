// Inputs and results of a servo cycle, in rings: enough to repeat every cycle bit for bit.
//
// Writer   the servo thread. In each cycle it writes mailbox entries first, then each hand, then the cycle:
//          a reader of a step in `cycles` finds its other records in the other rings, unless these lapped
// Step     counts all cycles from 1, including the dry ones before the start; key of all rings
// Reader   tact-record, which writes a file (ipc/record), and tact-replay
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
    std::uint32_t body = 0;  // an id or a structure; only the model can check its existence
    std::uint32_t reserved = 0;
    double pos_model_m[3] = {0.0, 0.0, 0.0};
    double quat_model_body_xyzw[4] = {0.0, 0.0, 0.0, 1.0};  // of unit length
};

// Report about the visual process and the controller to the servo.
struct HousekeepingReport {
    std::int64_t gui_heartbeat_ns;  // time of the GUI's last report; -1: never
    std::uint64_t gui_generation;
    std::uint64_t bad_input;
    std::uint64_t page_faults;  // of the servo thread, from /proc, since its request
    double gui_fps;
    double gui_busy_s;
    std::uint64_t gui_frame;            // of the newest report
    std::uint64_t gui_levels_sequence;  // of the levels that this frame applied
    std::int64_t gui_taken_at_ns;
    double gui_work_s;  // of the frame, without its wait
    double gui_cpu_s;   // processor time since its start
    std::uint32_t gui_vertices;
    std::uint32_t gui_vertices_max;
    std::uint32_t gui_particles_max;
    std::uint32_t gui_attached;  // 0 or 1
    double gui_particles_s;      // of the frame, for moving and drawing them
    // Costs of the other visual paths (LoadTopic::path_s).
    double gui_mesh_s, gui_volume_s, gui_molecules_s, gui_resolution_s;
    std::uint32_t gui_molecules_max, gui_pixels_max;
    std::uint32_t gui_refined;  // LoadTopic::refined, of the newest frame
    // What that frame shows, which is published only and not recorded; vertices or rays: gui_vertices.
    std::uint32_t gui_particles, gui_molecules, gui_pixels;
};

enum CycleFlag : std::uint8_t {
    kCycleDry = 1U << 0,    // before the start, with zero force
    kCycleLines = 1U << 1,  // safety inputs were read
};

struct CycleTopic {
    static constexpr TopicInfo kInfo{.name = "cycle", .version = 1, .writer = Writer::rt};
    static constexpr std::size_t kTimestampsMax = 5;
    std::uint64_t step;
    std::uint64_t cycle;                    // of the loop, from 1; dry cycles have their own count
    std::int64_t clock_ns[kTimestampsMax];  // every reading of the clock by the servo
    std::int64_t now_ns;                    // the reading used by the cycle
    std::int64_t lateness_ns;               // of its start
    std::int64_t cost_ns;                   // whole cycle
    std::int64_t model_ns;                  // the force models' steps
    float level;                            // of the haptic path
    float work_fraction;                    // of the level's work to recompute
    std::int64_t lines_taken_at_ns;         // safety inputs as read, with kCycleLines
    std::uint64_t lines_sequence, lines_trips;
    std::uint8_t lines_state, lines_cause, lines_inputs, lines_outputs;
    std::uint8_t run_state, run_reason;  // RunState, RunReason, at the end of the cycle
    std::uint8_t flags;                  // CycleFlag
    std::uint8_t timestamps;             // number of values in clock_ns
};
static_assert(std::is_trivially_copyable_v<CycleTopic> && sizeof(CycleTopic) == 128);

// One hand in one step.
struct HandTopic {
    static constexpr TopicInfo kInfo{.name = "hand", .version = 1, .writer = Writer::rt};
    std::uint64_t step;
    // From the device (DeviceSample).
    std::int64_t taken_at_ns;
    std::uint64_t sequence;
    double pos_dev_m[3];
    double quat_dev_tool_xyzw[4];
    double velocity_dev_m_s[3];
    double angular_dev_rad_s[3];
    std::int64_t delay_ns;
    // Results.
    double force_world_n[3];  // as sent to the device, after the safety chain
    double torque_world_n_m[3];
    double force_model_world_n[3];  // from the force model, before the safety chain
    double torque_model_world_n_m[3];
    float model_error_n;
    std::uint32_t items;  // evaluated
    std::uint32_t buttons;
    std::uint32_t deadline_check;  // number of the deadline check that found it passed, from 1; 0: none
    std::uint8_t read_status, write_status;  // IoStatus
    std::uint8_t hand_present, device_state, notice;
    std::uint8_t step_status;  // StepStatus
    std::uint8_t at_wall;      // 1: a wall of the workspace exerts force
    std::uint8_t reserved;     // zero
};
static_assert(std::is_trivially_copyable_v<HandTopic> && sizeof(HandTopic) == 256);
static_assert(offsetof(HandTopic, force_world_n) == 136);

enum class MailboxKind : std::uint32_t {
    none,
    order,
    model_taken,    // a model that was built in the background
    build_refused,  // the model could not be built
    stop,           // order.value: signal number; -1: the run time is over
    drops,          // order.sequence: drops by the supervisor so far
};

// An order to the servo, with the step that took it.
struct MailboxTopic {
    static constexpr TopicInfo kInfo{.name = "mailbox", .version = 1, .writer = Writer::rt};
    std::uint64_t step;
    std::uint32_t kind;      // MailboxKind
    std::uint32_t reserved;  // zero
    ServoOrder order;
};
static_assert(std::is_trivially_copyable_v<MailboxTopic> && sizeof(MailboxTopic) == 104);

struct ReportTopic {
    static constexpr TopicInfo kInfo{.name = "report", .version = 3, .writer = Writer::rt};
    std::uint64_t step;
    HousekeepingReport said;
};
static_assert(std::is_trivially_copyable_v<ReportTopic> && sizeof(ReportTopic) == 176);

enum StartFlag : std::uint32_t {
    kStartEmulated = 1U << 0,  // no real device
    kStartLines = 1U << 1,     // safety inputs are fitted
};

// A device, with the data from its open().
struct StartDevice {
    char name[64];  // ends with 0
    double workspace_half_m[3];
    double force_n_max, force_n_continuous, torque_n_m_max, stiffness_n_m_max, position_step_m;
};

// Start of the loop. Written once, before the first cycle.
struct alignas(64) StartTopic {
    static constexpr TopicInfo kInfo{.name = "start", .version = 1, .writer = Writer::rt};
    std::int64_t started_at_ns;
    std::uint64_t dry_steps;  // cycles before the start
    std::int64_t period_ns;   // 0: free running
    std::uint32_t hands;
    std::uint32_t flags;  // StartFlag
    double pos_world_dev_m[3];
    double quat_world_dev_xyzw[4];
    StartDevice device[2];
    std::uint8_t reserved[40];  // zero
};
static_assert(std::is_trivially_copyable_v<StartTopic> && sizeof(StartTopic) == 384);

// Start of the controller, for a repetition. Written before the region is ready.
struct RunText {
    static constexpr TopicInfo kInfo{.name = "runtext", .version = 2, .writer = Writer::rt};
    static constexpr std::size_t kArgumentsMax = 4096, kConfigMax = 32768, kPosesMax = 65536;
    static constexpr std::uint32_t kTooLong = 0xFFFFFFFFU;  // as a count: the text was too long
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
