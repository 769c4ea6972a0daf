// Holds the rate of a free-running loop between two steps of the law (rt/govern/rate_hold.hpp).
//
// Inactive  in loops of fixed rate, and under the law "fixed".
// Thread    servo; TACT_RT
#pragma once

#include "ipc/base/clock.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Reads the clock and records the reading, because replays need every input of a cycle.
[[nodiscard]] Instant timestamp(CycleState& c, Clock& clock) noexcept TACT_RT;
// Sleeps while the loop is ahead of its goal and a visual level is below 1, so the display gets the time at once.
// Returns the instant at which the loop continues.
[[nodiscard]] Instant rest(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept TACT_RT;
// Fraction of the models' work that this step recomputes.
[[nodiscard]] double work_fraction(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Adds the cost of a step that did all of its work to the statistics.
void count_work(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
