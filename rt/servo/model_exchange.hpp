// Stage 6: models come and go. What no constant time can make is built aside and taken over at a cycle boundary.
//
// Takes     a model that was rebuilt goes on where the old one was; any other enters with zero force and the ramp from
//           its beginning.
// Asks      for one model at a time: what is ordered while one is being built is asked for after it has come.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

void exchange_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;
// False: the model refused, as it knows which bodies and settings it has. Another structure in the hand is another
// load: it enters at a level that fits, and the governor goes on from there.
[[nodiscard]] bool order_model(CycleState& c, const ServoSettings& settings, const ServoIo& io,
                               const ServoOrder& order) noexcept TACT_RT;

}  // namespace tact::servo
