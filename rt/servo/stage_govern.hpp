// Stage 13: the governor. It is asked once an interval, and at each frame that was drawn with the present levels.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

void govern(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;
void start_interval(CycleState& c, Instant now) noexcept TACT_RT;
// The visual paths come and go together.
void set_display_present(CycleState& c, const ServoSettings& settings, bool present) noexcept TACT_RT;

}  // namespace tact::servo
