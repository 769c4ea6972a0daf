// The replay of a recorded run: where it is, what happened in the run, and what the window requests.
//
// ReplayTopic    from tact-replay; never published by a controller, so a window that has it shows a recording
// ReplayMarks    events of the whole recording, from its start; the most important ones if there are more than kMost
// TimelineTopic  what the window requests: a state, so reading it twice changes nothing
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

enum class ReplayAct : std::uint8_t { paused, playing, seeking, ended };

struct alignas(64) ReplayTopic {
    static constexpr TopicInfo kInfo{.name = "replay", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::int64_t shown_ns;  // time of the step that is shown, in the clock of the replayed topics
    double at_s;            // of that step, since the first one of the recording
    double duration_s;      // of the recording
    double speed;           // while it plays, relative to the recorded run
    double seek_share;      // of the steps to the place that is looked for; 1: found
    std::uint64_t step;     // shown, from 1
    std::uint64_t steps;    // in the recording
    std::uint64_t seeks;    // TimelineTopic::seeks of the last place that was found
    std::uint8_t act;       // ReplayAct
    std::uint8_t exact;     // 1: every force so far is that of the recording, to the bit
    std::uint8_t whole;     // 1: the recording begins with the run
    std::uint8_t plays;     // 1: it plays, or will once the place is found
    std::uint8_t can_run;   // 1: a live run can continue from here, started by `tact replay`
    std::uint8_t reserved[3];
    std::uint64_t runs;        // TimelineTopic::runs of the last such request; it waits there
    char name[64];             // of the recording's file, without its folder; ends with 0
    std::uint8_t padding[40];  // zero
};
static_assert(std::is_trivially_copyable_v<ReplayTopic> && sizeof(ReplayTopic) == 192);

struct ReplayMark {
    double at_s;
    std::uint16_t code;  // EventCode
    std::uint16_t detail;
    std::uint8_t grade;  // 0 ordinary, 1 watch, 2 bad
    std::uint8_t reserved[3];
};
static_assert(sizeof(ReplayMark) == 16);

struct alignas(64) ReplayMarks {
    static constexpr TopicInfo kInfo{.name = "replay marks", .version = 1, .writer = Writer::rt};
    static constexpr std::size_t kMost = 252;
    std::uint32_t count;
    std::uint32_t omitted;      // less important ones
    std::uint8_t reserved[56];  // zero
    ReplayMark mark[kMost];     // in the order of their times
};
static_assert(std::is_trivially_copyable_v<ReplayMarks> && sizeof(ReplayMarks) == 64 + 16 * 252);

struct alignas(64) TimelineTopic {
    static constexpr TopicInfo kInfo{.name = "timeline", .version = 1, .writer = Writer::gui};
    static constexpr double kSpeedLeast = 0.01, kSpeedMost = 100.0;
    std::int64_t taken_at_ns;
    double speed;
    std::uint64_t seeks;      // another number requests another place
    double seek_s;            // that place, if seek_step is 0
    std::uint64_t seek_step;  // from 1
    std::uint64_t runs;       // a change requests a live run from the moment shown
    std::uint8_t playing;
    std::uint8_t reserved[15];  // zero
};
static_assert(std::is_trivially_copyable_v<TimelineTopic> && sizeof(TimelineTopic) == 64);

[[nodiscard]] inline bool sensible(const TimelineTopic& t) noexcept {
    return t.speed >= TimelineTopic::kSpeedLeast && t.speed <= TimelineTopic::kSpeedMost &&
           std::isfinite(t.seek_s) && std::abs(t.seek_s) < 1e9;
}

}  // namespace tact
