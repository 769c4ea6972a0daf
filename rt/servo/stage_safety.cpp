#include "rt/servo/stage_safety.hpp"

#include <algorithm>

#include "rt/servo/fault_snapshot.hpp"
#include "rt/servo/report.hpp"
#include "rt/servo/stage_lines.hpp"
#include "rt/servo/stage_orders.hpp"

namespace tact::servo {

namespace {

// A stop ramps the force out within rt/safety's ramp_out_s; the amplifier is off after kStopMax at the latest.
constexpr Duration kStopMax = std::chrono::milliseconds(100);

bool device_lost(const HandCycle& h) noexcept {
    return h.read_status == IoStatus::lost || h.write_status == IoStatus::lost;
}

bool device_fault(const HandCycle& h, const ServoSettings& settings) noexcept {
    return h.read_status == IoStatus::fault || !h.sample_usable || h.sample.state == DeviceState::fault ||
           (h.sample.state == DeviceState::watchdog_tripped && settings.watchdogs.device_watchdog_latches);
}

// The hand whose device caused this trip.
std::uint32_t hand_at_fault(const CycleState& c, const ServoSettings& settings) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const HandCycle& h = c.hand[i];
        if ((c.run.reason == RunReason::device_lost && device_lost(h)) ||
            (c.run.reason == RunReason::device_fault && device_fault(h, settings)) ||
            (c.run.reason == RunReason::sample_stale &&
             c.now - h.sample.taken_at > settings.watchdogs.sample_age_max))
            return i;
    }
    return kNoHand;
}

WatchdogInput watched_of(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    WatchdogInput watched{.now = c.now,
                          .sample_taken_at = c.now,
                          .lateness = std::max(c.lateness, c.behind),
                          .overran = c.overran,
                          .lines = c.lines.stops,
                          .lines_age = c.lines.age,
                          .supervisor = supervisor_dropped(c, io)};
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const HandCycle& h = c.hand[i];
        watched.sample_taken_at = std::min(watched.sample_taken_at, h.sample.taken_at);
        watched.device_lost = watched.device_lost || device_lost(h);
        watched.device_fault = watched.device_fault || device_fault(h, settings);
        watched.force_finite = watched.force_finite && h.wanted_world.finite();
    }
    return watched;
}

void advance_state(CycleState& c, const ServoIo& io) noexcept {
    c.events.trip = c.trip.reason;
    const int signal = io.mailbox.stop_signal.load(std::memory_order_relaxed);
    c.events.stop = signal != 0;
    if (c.events.stop && !c.stopping) {
        report(c, io.region, EventCode::stopping, static_cast<double>(signal), 0.0);
        record_mailbox(c, io.region, MailboxKind::stop,
                       {.sequence = 0, .value = static_cast<double>(signal), .kind = 0, .index = 0});
    }
    c.stopping = c.events.stop;
    c.events.hand_present = true;
    bool still = true;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        c.events.hand_present = c.events.hand_present && c.hand[i].sample.hand_present;
        still = still && c.hand[i].out.gain <= 0.0;
    }
    c.events.close =
        c.events.stop && !c.dry && (still || (!amplifier_on(c.run.state) && c.now - c.run.since > kStopMax));
    if (!c.dry) c.run = next_status(c.run, c.events, c.now);
}

// Each limit is reported at most twice a second, so that a lasting one does not fill the event ring.
void report_limits(CycleState& c, HandCycle& h, RtRegion& region) noexcept {
    if (c.dry || h.out.acts == 0 || !force_may_flow(c.run.state)) return;
    const ChainSettings& limit = h.chain.settings();
    const auto due = [&](std::uint32_t act, std::size_t index) {
        if ((h.out.acts & act) == 0 || c.now - h.reported_at[index] < std::chrono::milliseconds(500))
            return false;
        h.reported_at[index] = c.now;
        return true;
    };
    if (due(kChainForce, 3)) report(c, region, EventCode::force_limited, h.out.wanted_n, limit.force_n_max);
    if (due(kChainTorque, 4))
        report(c, region, EventCode::torque_limited, h.out.wanted_n_m, limit.torque_n_m_max);
    if (due(kChainSlew, 6))
        report(c, region, EventCode::slew_limited, h.out.step_n, limit.force_slew_n_s * to_s(c.dt));
    if (due(kChainTorqueSlew, 7))
        report(c, region, EventCode::torque_slew_limited, h.out.step_n_m,
               limit.torque_slew_n_m_s * to_s(c.dt));
}

void report_notice(CycleState& c, HandCycle& h, std::uint32_t hand, RtRegion& region) noexcept {
    if (c.dry || h.sample.notice == h.reported) return;
    h.reported = h.sample.notice;
    report(c, region, EventCode::device_notice, static_cast<double>(h.reported), static_cast<double>(hand));
    c.report.health_due = true;
}

void apply_chain(CycleState& c, HandCycle& h, const ServoSettings& settings, RtRegion& region) noexcept {
    // If the watchdog of an emulated device latches no fault, one cycle without enable provides its rising edge,
    // and the ramp restarts.
    const bool dropped = h.sample.state == DeviceState::watchdog_tripped;
    if (dropped && amplifier_on(c.run.state))
        report(c, region, EventCode::device_watchdog, to_us(c.dt) * 1e-3, 0.0);
    const Quat back = settings.T_world_dev.q.conjugate();
    h.out = h.chain.apply(
        {.wanted_dev = {back * h.wanted_world.force_n, back * h.wanted_world.torque_n_m},
         .T_dev_tool = h.sample.T_dev_tool,
         .dt = c.dt,
         .force_on = force_may_flow(c.run.state),
         .gate_open = c.run.state != RunState::off && c.run.state != RunState::fault && !dropped,
         .amplifier = amplifier_on(c.run.state),
         .wall_gain = h.walls.gain()});
    h.shown_world = {settings.T_world_dev.q * h.out.wrench_dev.force_n,
                     settings.T_world_dev.q * h.out.wrench_dev.torque_n_m};
}

}  // namespace

void make_safe(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    c.trip = c.watchdogs.check(watched_of(c, settings, io));
    if (c.watchdogs.warns())
        report(c, io.region, EventCode::overrun, to_us(c.cost), static_cast<double>(c.pacer.overruns()));

    const RunState before = c.run.state;
    advance_state(c, io);
    answer_state_order(c, before, io.region);
    rearm_lines(c, before, io);

    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        apply_chain(c, h, settings, io.region);
        report_limits(c, h, io.region);
        report_notice(c, h, i, io.region);
    }
    if (c.run.state == before) return;
    report(c, io.region, EventCode::state_changed, static_cast<double>(before),
           static_cast<double>(c.run.state));
    if (c.run.state == RunState::fault) note_fault(c, io, hand_at_fault(c, settings));
    if (c.run.state == RunState::off) c.finished = true;
    c.report.health_due = true;
}

}  // namespace tact::servo
