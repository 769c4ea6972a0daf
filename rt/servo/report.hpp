// Publishes events, answers to commands, and mailbox entries for recordings.
//
// Thread    servo; TACT_RT
#pragma once

#include "ipc/topics/event.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

void report(CycleState& c, RtRegion& region, EventCode code, double a, double b,
            std::uint16_t detail = 0) noexcept TACT_RT;
// Answers a command. A command without a sequence number came from the controller itself.
void acknowledge(CycleState& c, RtRegion& region, const ServoOrder& order,
                 CommandResult result) noexcept TACT_RT;
void record_mailbox(const CycleState& c, RtRegion& region, MailboxKind kind,
                    const ServoOrder& order) noexcept TACT_RT;

}  // namespace tact::servo
