// Events and answers of a cycle, and what a recording needs of the mailbox.
//
// Thread    servo; TACT_RT
#pragma once

#include "ipc/topics/event.hpp"
#include "rt/servo/cycle.hpp"

namespace tact::servo {

void report(CycleState& c, RtRegion& region, EventCode code, double a, double b,
            std::uint16_t detail = 0) noexcept TACT_RT;
// Answers a command; one without a sequence number was given by the controller itself.
void acknowledge(CycleState& c, RtRegion& region, const ServoOrder& order,
                 CommandResult result) noexcept TACT_RT;
void record_mailbox(const CycleState& c, RtRegion& region, MailboxKind kind,
                    const ServoOrder& order) noexcept TACT_RT;

}  // namespace tact::servo
