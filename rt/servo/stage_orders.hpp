// Stage 2: the mailbox. Orders of a person, and what the visual process reports.
//
// Orders    arm and disarm first, past all others; disarm wins. Then at most four of the others a cycle, and none behind one
//           that concerns the state; the state machine answers that one.
// Silence   of a visual process that ever reported, whether it left or hangs.
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Sets housekeeping, order and events of this cycle; answers every other order.
void take_orders(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept TACT_RT;
// After the state machine.
void answer_state_order(CycleState& c, RunState before, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
