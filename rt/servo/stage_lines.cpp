#include "rt/servo/stage_lines.hpp"

#include "rt/servo/line_names.hpp"
#include "rt/servo/report.hpp"

namespace tact::servo {

namespace {

RunReason lines_stop(const CycleState& c, const ServoSettings& settings) noexcept {
    const LinesCycle& l = c.lines;
    if (l.sample.sequence == 0 || l.age > settings.lines_age_max) return RunReason::lines_lost;
    if (l.sample.state == LinesState::stopped) return reason_of(l.sample.cause);
    // A stop that came and went between two samples.
    if (amplifier_on(c.run.state) && l.sample.trips != l.trips_at_arming) {
        return l.sample.cause == LinesCause::none ? RunReason::lines_lost : reason_of(l.sample.cause);
    }
    return RunReason::none;
}

}  // namespace

void check_lines(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    c.lines.fitted = io.lines != nullptr;
    if (!c.lines.fitted) return;
    LinesCycle& l = c.lines;
    const LinesSample before = l.sample;
    static_cast<void>(io.lines->read(l.sample, c.now));
    l.age = l.sample.sequence == 0 ? Duration{0} : c.now - l.sample.taken_at;
    l.stops = c.dry ? RunReason::none : lines_stop(c, settings);
    // Contacts that have not been closed long enough since the start bar arming but are no fault.
    c.events.arm_barred = l.stops != RunReason::none || l.sample.state == LinesState::stopped;
    if (c.dry || (before.state == l.sample.state && before.cause == l.sample.cause)) return;
    report(c, io.region, EventCode::lines_changed, static_cast<double>(shown(l.sample.state)),
           static_cast<double>(reason_of(l.sample.cause)));
    c.report.health_due = true;
}

bool supervisor_dropped(CycleState& c, const ServoIo& io) noexcept {
    const std::uint64_t drops = io.mailbox.pulse.drops.load(std::memory_order_acquire);
    const bool dropped = drops != c.lines.drops_seen;
    c.lines.drops_seen = drops;
    if (dropped)
        record_mailbox(c, io.region, MailboxKind::drops,
                       {.sequence = drops, .value = 0.0, .kind = 0, .index = 0});
    return dropped;
}

// A reset ends in ready and arming in armed, never with force.
void rearm_lines(CycleState& c, RunState before, const ServoIo& io) noexcept {
    const bool reset = before == RunState::fault && c.run.state == RunState::ready;
    const bool armed = before == RunState::ready && c.run.state == RunState::armed;
    if (!reset && !armed) return;
    io.mailbox.pulse.rearms.fetch_add(1, std::memory_order_release);
    ++c.lines.command.rearm;
    c.lines.trips_at_arming = c.lines.sample.trips;
}

void drive_lines(CycleState& c, const ServoIo& io) noexcept {
    bool enable = false;
    for (std::uint32_t i = 0; i < c.hands; ++i) enable = enable || c.hand[i].out.enable;
    // Store the time first, so that the supervisor never reads an enable with an older beat.
    io.mailbox.pulse.beat_ns.store(to_ns(c.now), std::memory_order_relaxed);
    io.mailbox.pulse.enabled.store(enable && !c.dry, std::memory_order_release);
    if (io.lines == nullptr) return;
    LinesCommand& out = c.lines.command;
    ++out.heartbeat;
    out.enable = enable && !c.dry;
    out.lamp = c.run.state == RunState::fault ? Lamp::blinking
               : amplifier_on(c.run.state)    ? Lamp::lit
                                              : Lamp::dark;
    io.lines->write(out, c.now);
}

}  // namespace tact::servo
