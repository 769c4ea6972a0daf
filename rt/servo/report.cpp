#include "rt/servo/report.hpp"

namespace tact::servo {

void report(CycleState& c, RtRegion& region, EventCode code, double a, double b,
            std::uint16_t detail) noexcept {
    ++c.report.events;
    EventTopic e{};
    e.taken_at_ns = to_ns(c.now);
    e.cycle = c.cycle;
    e.code = static_cast<std::uint16_t>(code);
    e.detail = detail;
    e.a = a;
    e.b = b;
    region.events.push(e);
}

void acknowledge(CycleState& c, RtRegion& region, const ServoOrder& order, CommandResult result) noexcept {
    report(c, region, EventCode::command_done, static_cast<double>(order.kind), static_cast<double>(result));
    c.report.health_due = true;
    if (order.sequence == 0) return;
    c.report.last_sequence = order.sequence;
    c.report.last_result = result;
    const auto kind = static_cast<CommandKind>(order.kind);
    if (kind != CommandKind::arm && kind != CommandKind::disarm) return;
    c.report.state_sequence = order.sequence;
    c.report.state_result = result;
}

void record_mailbox(const CycleState& c, RtRegion& region, MailboxKind kind,
                    const ServoOrder& order) noexcept {
    region.mailbox.push(
        {.step = c.step, .kind = static_cast<std::uint32_t>(kind), .reserved = 0, .order = order});
}

}  // namespace tact::servo
