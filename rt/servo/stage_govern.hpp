// Stage 13: levels. The haptic level is fitted every cycle; the law runs once an interval and at each frame that was
// drawn with the present levels.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

void govern(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;
void start_interval(CycleState& c, Instant now) noexcept TACT_RT;
// Sets all visual paths present or absent.
void set_display_present(CycleState& c, const ServoSettings& settings, bool present) noexcept TACT_RT;

}  // namespace tact::servo
