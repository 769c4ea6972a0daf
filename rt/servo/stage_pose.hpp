// Stage 5: from the devices' frames to the world.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets each hand's tool. Without a usable sample the last good one stays; the watchdog decides.
void pose(CycleState& c, const ServoSettings& settings) noexcept TACT_RT;

}  // namespace tact::servo
