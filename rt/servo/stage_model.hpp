// Stage 7: steps the force models within their budget.
//
// Drives    a tool runs while its switch and the force are on; a switch that cannot be read is off.
// Budget    the governor's level, and a deadline as a safety net; in a replay the recorded values.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Sets budget, each hand's step, model_cost, deadline_missed and recomputed_fraction. Reads the clock twice.
void step_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
