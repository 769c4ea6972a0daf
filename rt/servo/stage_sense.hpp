// Stage 4: reads the devices.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets each hand's newest sample, its status, and whether it is usable (device not lost, all values finite).
void sense(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
