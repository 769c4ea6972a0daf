// How the controller is doing, ten times a second and at every change of state.
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

// Safety lines: LinesState of hal/api/lines.hpp, and none.
enum class LinesShown : std::uint8_t { none, stopped, waiting, permitted };

struct alignas(64) HealthTopic {
    static constexpr TopicInfo kInfo{.name = "health", .version = 7, .writer = Writer::rt};
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
    std::uint64_t bad_input;            // records from the other process refused
    std::uint64_t events;               // published so far
    std::uint64_t command_sequence;     // last one handled
    std::uint32_t command_result;       // CommandResult of it
    std::uint32_t schedule_flags;       // ScheduleFlag
    std::int64_t gui_heartbeat_age_ns;  // -1: never seen
    double gui_fps;                     // echoed from the load topic
    std::uint32_t gui_vertices;
    std::uint8_t state;         // RunState
    std::uint8_t reason;        // RunReason
    std::uint8_t gui_attached;  // 0 or 1
    std::uint8_t device_state;  // DeviceState
    // Of the model's work, what the updates did anew: mean and least of the last tenth of a second. Below 1 a
    // freely running loop kept its rate by using older partial sums.
    float recomputed_fraction_mean, recomputed_fraction_least;
    float rested;  // of that time; it left this to others while it was ahead of its goal
    // From the encoders to the motors, of the last second, the slower hand; 0: no device says.
    float stiffness_n_m_max;  // that walls and model may have at this delay
    std::int64_t delay_p50_ns;
    std::int64_t delay_p99_ns;
    std::uint8_t lines;             // LinesShown
    std::uint8_t lines_reason;      // RunReason: what they stop for, or stopped last
    std::uint8_t device_notice[2];  // DeviceNotice of each hand
    BusCounts device_bus[2];        // of each hand
    std::uint16_t state_result;     // CommandResult of state_sequence
    std::uint8_t reserved[2];       // zero
    std::int64_t overrun_at_ns;     // the last one; 0: none
    std::uint64_t state_sequence;   // last arm or disarm handled: they overtake other commands
};
static_assert(std::is_trivially_copyable_v<HealthTopic> && sizeof(HealthTopic) == 320);
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
