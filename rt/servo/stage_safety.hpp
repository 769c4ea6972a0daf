// Stage 9: watchdogs, state machine, and the output chain for every force.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Sets trip, run, and each hand's out and shown_world. A fault publishes a snapshot in the mailbox.
void make_safe(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
