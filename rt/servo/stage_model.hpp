// Stage 7: steps the force models within their budget.
//
// Drives    a tool runs while its switch is on and the force is on; a switch that cannot be read is off.
// Budget    the governor's level, and a deadline beneath it; of a repeated cycle as recorded.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Sets budget, each hand's step, model_cost, deadline_missed and recomputed_fraction. Reads the clock twice.
void step_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;

}  // namespace tact::servo
