// Stage 8: limits field, walls and damping to values that are stable at the delay of the devices.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets the bounds for the delay and the period of the last second.
void bound_by_delay(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;
// Sets each hand's wanted wrench.
void shape(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;

}  // namespace tact::servo
