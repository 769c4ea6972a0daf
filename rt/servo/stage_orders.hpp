// Stage 2: takes orders and the reports of the visual process from the mailbox.
//
// Orders    arm and disarm first, before all others; disarm wins. Then at most four others per cycle, and none after an
//           order to the state machine, which answers it.
// Silence   reported for a visual process that has reported before, whether it ended or hangs.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Sets housekeeping, order and events of this cycle; answers all orders except those to the state machine.
void take_orders(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;
// Call after the state machine.
void answer_state_order(CycleState& c, RunState before, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
