// Stage 14: the end of the cycle. Its cost, whether it overran, its record and its trace.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Reads the clock once. Sets cost, behind and overran.
void close(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
