// Stage 1: waits for the planned time of the cycle and reads the clock.
//
// Thread    servo; TACT_RT
#pragma once

#include "ipc/base/clock.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets now, planned, lateness and dt, and counts the cycle. Dry and free-running cycles are never late.
void wake(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept TACT_RT;

}  // namespace tact::servo
