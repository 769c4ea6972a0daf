// State of the controller, ten times per second and at every change of state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/base/bus_counts.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/run_state.hpp"
#include "ipc/shm/topic.hpp"

namespace tact {

enum ScheduleFlag : std::uint32_t {
    kScheduleFifo = 1U << 0,
    kSchedulePinned = 1U << 1,
    kScheduleIsolated = 1U << 2,
    kScheduleLocked = 1U << 3,      // mlockall
    kScheduleDmaLatency = 1U << 4,  // /dev/cpu_dma_latency held at 0
};

// Safety inputs: LinesState of hal/api/lines.hpp, or none.
enum class LinesShown : std::uint8_t { none, stopped, waiting, permitted };

struct alignas(64) HealthTopic {
    static constexpr TopicInfo kInfo{.name = "health", .version = 8, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::int64_t period_ns;     // 0: free running
    double force_rate_hz;       // updates in the last window / its length
    double force_rate_mean_hz;  // since the loop started
    double goal_hz;
    std::int64_t lateness_p50_ns;  // of the last window (one second)
    std::int64_t lateness_p99_ns;
    std::int64_t lateness_max_ns;
    std::int64_t cycle_cost_p50_ns;  // work of a cycle, of the last window
    std::int64_t cycle_cost_max_ns;
    std::uint64_t overruns;     // cycles that ended after the next one was due, since start
    std::uint64_t skipped;      // periods skipped because of them
    std::uint64_t allocations;  // on the servo thread inside a cycle, since start
    std::uint64_t locks;
    std::uint64_t page_faults;          // minor and major, servo thread, since the loop started
    std::uint64_t bad_input;            // refused records from the other process
    std::uint64_t events;               // published so far
    std::uint64_t command_sequence;     // last command handled
    std::uint32_t command_result;       // CommandResult of it
    std::uint32_t schedule_flags;       // ScheduleFlag
    std::int64_t gui_heartbeat_age_ns;  // -1: never seen
    double gui_fps;                     // echoed from the load topic
    std::uint32_t gui_vertices;
    std::uint8_t state;         // RunState
    std::uint8_t reason;        // RunReason
    std::uint8_t gui_attached;  // 0 or 1
    std::uint8_t device_state;  // DeviceState
    // Fraction of the model's work that the updates recomputed: mean and minimum of the last 0.1 s. Below
    // 1, a free-running loop kept its rate by using older partial sums.
    float recomputed_fraction_mean, recomputed_fraction_least;
    float rested;  // fraction of that time left to other threads while ahead of the goal
    // Delay from the encoders to the motors in the last second, for the slower hand; 0: no device reports it.
    float stiffness_n_m_max;  // permitted for walls and model at this delay
    std::int64_t delay_p50_ns;
    std::int64_t delay_p99_ns;
    std::uint8_t lines;             // LinesShown
    std::uint8_t lines_reason;      // RunReason of the present or last stop
    std::uint8_t device_notice[2];  // DeviceNotice of each hand
    BusCounts device_bus[2];        // of each hand
    std::uint16_t state_result;     // CommandResult of state_sequence
    std::uint8_t reserved[2];       // zero
    std::int64_t overrun_at_ns;     // the last one; 0: none
    // Of the cycles with force since the loop started (rt/servo/armed_metrics.hpp).
    std::uint64_t armed_cycles;
    std::uint64_t deadline_misses;       // steps of the force model that ended after their deadline
    std::int64_t deadline_missed_at_ns;  // the last one; 0: none
    float deadline_miss_share;           // of the armed cycles of the last second
    float force_error_n_p50;             // median of the published error bound
    float force_step_n_max;              // largest change of the force from one cycle to the next
    float level_settled_s;      // after arming the level stays within 5 % from then on; negative: not armed
    std::int64_t model_ns_max;  // deadline of the model's step; 0: none
    std::uint64_t state_sequence;  // last arm or disarm handled: they overtake other commands
    // Stiffness that the model shows now (the stiffer hand), before the gain for the delay; 0: unknown.
    float model_n_m, model_n_m_rad;
    float torque_n_m_rad_max;  // permitted in rotation at this delay, as stiffness_n_m_max
    float field_gain;          // factor on the model's wrench that keeps it stable (the weaker hand)
};
static_assert(std::is_trivially_copyable_v<HealthTopic> && sizeof(HealthTopic) == 384);
static_assert(offsetof(HealthTopic, overrun_at_ns) == 304 && offsetof(HealthTopic, device_bus) == 220 &&
              sizeof(BusCounts) == 40);

// The lateness histogram since start, once a second and at the end. Buckets as in DurationHistogram.
struct alignas(64) LatenessTopic {
    static constexpr TopicInfo kInfo{.name = "lateness", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t total;
    std::uint64_t max_ns;
    std::uint64_t reserved;  // zero
    std::uint64_t counts[DurationHistogram::kBuckets];
    std::uint8_t padding[32];  // zero
};
static_assert(std::is_trivially_copyable_v<LatenessTopic> && sizeof(LatenessTopic) % 64 == 0);

}  // namespace tact
