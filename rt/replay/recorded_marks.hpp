// The events of a recording as marks on its timeline.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/topics/event.hpp"
#include "ipc/topics/replay.hpp"

namespace tact {

// A recording may hold any numbers: no overflow.
[[nodiscard]] inline double seconds_since(std::int64_t begin_ns, std::int64_t ns) noexcept {
    return 1e-9 * (static_cast<double>(ns) - static_cast<double>(begin_ns));
}

// 2 what stopped the run, 1 what limited it or was marked by a person, 0 else.
[[nodiscard]] std::uint8_t mark_grade(const EventTopic& event) noexcept;

// At most ReplayMarks::kMost, the graver ones first; events of one code and grade within kTogetherS are one mark.
inline constexpr double kTogetherS = 0.5;
[[nodiscard]] ReplayMarks marks_of(const std::vector<EventTopic>& events, std::int64_t begin_ns);

}  // namespace tact
