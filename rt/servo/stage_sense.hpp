// Stage 4: reads the devices.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Of each hand: the newest sample, its status, and whether it is usable (not lost, all of it finite).
void sense(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
