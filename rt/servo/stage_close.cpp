#include "rt/servo/stage_close.hpp"

#include "rt/servo/rate_keeping.hpp"
#include "rt/servo/record.hpp"
#include "rt/servo/report.hpp"
#include "rt/servo/topic_fill.hpp"

namespace tact::servo {

namespace {

void publish_trace(const CycleState& c, RtRegion& region) noexcept {
    const HandCycle& h = c.hand[0];
    TraceTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    t.lateness_ns = cut_ns(c.lateness);
    t.cost_ns = cut_ns(c.cost);
    t.model_ns = cut_ns(c.model_cost);
    t.level = c.governor.level(kForcePathIndex);
    put(t.pos_world_m, h.tool.T_world_tool.p_m);
    put(t.force_world_n, h.shown_world.force_n);
    put(t.torque_world_n_m, h.shown_world.torque_n_m);
    t.status = static_cast<std::uint32_t>(c.run.state) | static_cast<std::uint32_t>(h.step.status) << 8 |
               h.step.trace_flags;
    t.model_error_n = static_cast<float>(h.step.load.error);
    t.items = static_cast<std::uint32_t>(
        h.step.load.recomputed_fraction * static_cast<float>(h.step.load.items) + 0.5F);
    region.trace.push(t);
}

void note_overrun(CycleState& c, Instant end, RtRegion& region) noexcept {
    ++c.govern.overruns;
    c.report.overrun_at_ns = to_ns(end);
    if (end - c.report.overrun_reported_at <= std::chrono::milliseconds(100)) return;
    c.report.overrun_reported_at = end;
    report(c, region, EventCode::overrun, to_us(end - c.planned), static_cast<double>(c.pacer.overruns()));
}

}  // namespace

void close(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    const Instant end = timestamp(c, io.clock);
    c.cost = end - c.now;
    c.govern.other_s = to_s(c.cost - c.model_cost);
    publish_cycle(c, io.region);
    if (c.dry) return;
    c.statistics.spent(c.cost);
    c.govern.cost += c.cost;
    count_work(c);
    if (settings.free_running) {
        c.behind = c.cost;  // without a planned time, only a long cycle is late
    } else {
        c.behind = end - c.planned - settings.period;
        c.overran = c.pacer.ended(end);
    }
    if (c.overran) note_overrun(c, end, io.region);
    publish_trace(c, io.region);
}

}  // namespace tact::servo
