// The servo's side of the safety lines: what they stop, when a person has re-armed them, what they show.
#include "rt/servo/line_names.hpp"
#include "rt/servo/servo.hpp"

namespace tact {

void Servo::check_lines(CycleState& c) noexcept {
    if (lines_ == nullptr) return;
    LinesCycle& l = c.lines;
    const LinesSample before = l.sample;
    static_cast<void>(lines_->read(l.sample, c.now));
    l.age = l.sample.sequence == 0 ? Duration{0} : c.now - l.sample.taken_at;
    l.stops = dry_ ? RunReason::none : lines_stop(c);
    // Contacts that have not stood long enough since the start are no fault; nothing is armed over them.
    c.events.arm_barred = l.stops != RunReason::none || l.sample.state == LinesState::stopped;
    if (dry_ || (before.state == l.sample.state && before.cause == l.sample.cause)) return;
    report(EventCode::lines_changed, static_cast<double>(shown(l.sample.state)),
           static_cast<double>(reason_of(l.sample.cause)));
    health_due_ = true;
}

RunReason Servo::lines_stop(const CycleState& c) const noexcept {
    const LinesCycle& l = c.lines;
    if (l.sample.sequence == 0 || l.age > settings_.lines_age_max) return RunReason::lines_lost;
    if (l.sample.state == LinesState::stopped) return reason_of(l.sample.cause);
    // A stop that came and went while the servo did not look.
    if (amplifier_on(c.run.state) && l.sample.trips != l.trips_at_arming) {
        return l.sample.cause == LinesCause::none ? RunReason::lines_lost : reason_of(l.sample.cause);
    }
    return RunReason::none;
}

bool Servo::supervisor_dropped(CycleState& c) noexcept {
    const std::uint64_t drops = mailbox_.pulse.drops.load(std::memory_order_acquire);
    const bool dropped = drops != c.drops_seen;
    c.drops_seen = drops;
    if (dropped) record_mailbox(MailboxKind::drops, {.sequence = drops, .value = 0.0, .kind = 0, .index = 0});
    return dropped;
}

// By a person: a reset, or arming. Both end at ready and armed, never at a force.
void Servo::rearm_lines(CycleState& c, RunState before) noexcept {
    const bool reset = before == RunState::fault && c.run.state == RunState::ready;
    const bool armed = before == RunState::ready && c.run.state == RunState::armed;
    if (!reset && !armed) return;
    mailbox_.pulse.rearms.fetch_add(1, std::memory_order_release);
    ++c.lines.command.rearm;
    c.lines.trips_at_arming = c.lines.sample.trips;
}

void Servo::drive_lines(CycleState& c) noexcept {
    bool enable = false;
    for (std::uint32_t i = 0; i < c.hands; ++i) enable = enable || c.hand[i].out.enable;
    // The time first: the supervisor must never see an enable with an older beat.
    mailbox_.pulse.beat_ns.store(to_ns(c.now), std::memory_order_relaxed);
    mailbox_.pulse.enabled.store(enable && !dry_, std::memory_order_release);
    if (lines_ == nullptr) return;
    LinesCommand& out = c.lines.command;
    ++out.heartbeat;
    out.enable = enable && !dry_;
    out.lamp = c.run.state == RunState::fault ? Lamp::blinking
               : amplifier_on(c.run.state)    ? Lamp::lit
                                              : Lamp::dark;
    lines_->write(out, c.now);
}

}  // namespace tact
