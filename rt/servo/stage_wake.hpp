// Stage 1: waits for the instant of the cycle, and takes it.
//
// Thread    servo; TACT_RT
#pragma once

#include "ipc/base/clock.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets now, planned, lateness and dt, and counts the cycle. A dry or freely running cycle is never late.
void wake(CycleState& c, const ServoSettings& settings, Clock& clock) noexcept TACT_RT;

}  // namespace tact::servo
