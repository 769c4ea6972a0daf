// Stage 14: ends the cycle. Measures its cost, detects an overrun, publishes record and trace.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Reads the clock once. Sets cost, behind and overran.
void close(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
