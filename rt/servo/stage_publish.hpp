// Stage 12: publishes the cycle. Tools and bodies each cycle, health and devices ten times a second.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Each model publishes its own topic here too (ForceModel::publish).
void publish(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
