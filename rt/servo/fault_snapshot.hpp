// Records the state of the loop at the first fault for the log.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"
#include "rt/servo/servo_io.hpp"

namespace tact::servo {

// Publishes the snapshot in the mailbox and reports the fault. hand: whose device caused it; kNoHand: no device, and the
// snapshot is of the first hand.
inline constexpr std::uint32_t kNoHand = ~0U;
void note_fault(CycleState& c, const ServoIo& io, std::uint32_t hand) noexcept TACT_RT;

}  // namespace tact::servo
