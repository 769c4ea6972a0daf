// Stage 6: exchanges force models. Work without a constant-time bound is done by the builder thread; the servo takes
// the finished model at a cycle boundary.
//
// Takes     a rebuilt model continues from the state of the old one; any other model starts with zero force and the
//           ramp from its beginning.
// Requests  one model at a time: orders given during a build are requested after it has arrived.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

void exchange_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;
// False: the model refused the order. Another structure in the hand starts at a level that fits its cost.
[[nodiscard]] bool order_model(CycleState& c, const ServoSettings& settings, const ServoIo& io,
                               const ServoOrder& order) noexcept TACT_RT;

}  // namespace tact::servo
