// Stage 12: publishes tools and bodies each cycle, health and devices ten times a second.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Also lets each model publish its own topic (ForceModel::publish).
void publish(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
