// Keeps the rate of a freely running loop between two steps of the law (rt/govern/rate_hold.hpp).
//
// Which     loops of fixed rate have their instants and their deadline for that; a level that a person fixed stays.
// Thread    servo; TACT_RT
#pragma once

#include "ipc/base/clock.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Reads the clock. What a cycle depends on is recorded, each reading of the clock among it.
[[nodiscard]] Instant timestamp(CycleState& c, Clock& clock) noexcept TACT_RT;
// Waits where the loop is ahead of its goal and the display is coarser than it could be: the display has the time at
// once, long before the law makes it finer. The instant at which the loop goes on.
[[nodiscard]] Instant rest(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept TACT_RT;
// Of the models' work, the fraction that this step may recompute.
[[nodiscard]] double work_fraction(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Remembers what a step costs that did all of its work.
void count_work(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
