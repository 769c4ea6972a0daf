// Stage 5: transforms poses and velocities from the device frames to the world frame.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets each hand's tool. Without a usable sample the last good pose stays; the watchdogs handle the loss.
void pose(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;

}  // namespace tact::servo
