#include "rt/servo/fault_snapshot.hpp"

#include "rt/servo/report.hpp"

namespace tact::servo {

void note_fault(CycleState& c, const ServoIo& io, std::uint32_t hand) noexcept {
    const HandCycle& h = c.hand[hand < c.hands ? hand : 0];
    FaultSnapshot s{};
    s.cycle = c.cycle;
    s.taken_at_ns = to_ns(c.now);
    s.lateness_ns = c.lateness.count();
    s.sample_age_ns = (c.now - h.sample.taken_at).count();
    s.measured = c.trip.measured;
    s.reason = static_cast<std::uint64_t>(c.run.reason);
    TraceTopic last{};
    RingCursor at{.next = io.region.trace.pushed(), .missed = 0};
    const bool known = at.next > 0 && io.region.trace.next(at, last);
    for (int i = 0; i < 3; ++i) {
        s.pos_world_m[i] = h.tool.T_world_tool.p_m[i];
        s.velocity_world_m_s[i] = h.tool.twist_world.linear_m_s[i];
        s.wanted_n[i] = h.wanted_world.force_n[i];
        s.applied_before_n[i] = known ? static_cast<double>(last.force_world_n[i]) : 0.0;
    }
    io.mailbox.fault.publish(s);
    report(c, io.region, EventCode::fault_latched, static_cast<double>(c.run.reason), c.trip.measured,
           static_cast<std::uint16_t>(hand < c.hands ? hand + 1 : 0));
}

}  // namespace tact::servo
