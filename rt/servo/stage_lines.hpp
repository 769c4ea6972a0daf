// Stages 3 and 11: read the safety inputs, re-arm them, drive their outputs.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Reads the lines; sets the reason for a stop and whether arming is barred.
void check_lines(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;
// True: the supervisor has dropped the enable line since the last cycle.
[[nodiscard]] bool supervisor_dropped(CycleState& c, const ServoIo& io) noexcept TACT_RT;
// After the state machine: a reset or arming by a person re-arms lines and supervisor.
void rearm_lines(CycleState& c, RunState before, const ServoIo& io) noexcept TACT_RT;
// Updates the heartbeat for the supervisor and writes the outputs.
void drive_lines(CycleState& c, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
