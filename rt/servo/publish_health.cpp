#include "rt/servo/publish_health.hpp"

#include <algorithm>

#include "rt/servo/line_names.hpp"
#include "rt/servo/rt_guard.hpp"

namespace tact::servo {

void publish_health(CycleState& c, const ServoSettings& settings, Latest<HealthTopic>& topic) noexcept {
    c.report.health_due = false;
    const WindowMetrics& f = c.statistics.metrics;
    HealthTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    t.period_ns = settings.free_running ? 0 : settings.period.count();
    t.force_rate_hz = c.statistics.rate.rate_hz();
    t.force_rate_mean_hz = c.statistics.rate.mean_hz(c.now);
    t.goal_hz = c.governor.settings().goal_hz;
    t.lateness_p50_ns = f.lateness_p50_ns;
    t.lateness_p99_ns = f.lateness_p99_ns;
    t.lateness_max_ns = f.lateness_max_ns;
    t.cycle_cost_p50_ns = f.cost_p50_ns;
    t.cycle_cost_max_ns = f.cost_max_ns;
    t.overruns = c.pacer.overruns();
    t.overrun_at_ns = c.report.overrun_at_ns;
    t.skipped = c.pacer.skipped();
    t.armed_cycles = c.armed.cycles();
    t.deadline_misses = c.armed.deadline_misses();
    t.deadline_missed_at_ns = to_ns(c.armed.missed_at());
    t.deadline_miss_share = static_cast<float>(c.armed.last_second_share());
    t.force_error_n_p50 = static_cast<float>(c.armed.force_error_n_p50());
    t.force_step_n_max = static_cast<float>(c.armed.force_step_n_max());
    t.level_settled_s = static_cast<float>(c.armed.level_settled_s());
    t.model_ns_max = settings.model_deadline ? settings.model_max.count() : 0;
    t.allocations = rt_guard::counts().allocations;
    t.locks = rt_guard::counts().locks;
    t.page_faults = std::max(c.housekeeping.page_faults, c.report.page_faults);
    t.bad_input = c.housekeeping.bad_input;
    t.events = c.report.events;
    t.command_sequence = c.report.last_sequence;
    t.command_result = static_cast<std::uint32_t>(c.report.last_result);
    t.state_sequence = c.report.state_sequence;
    t.state_result = static_cast<std::uint16_t>(c.report.state_result);
    t.schedule_flags = c.report.schedule_flags;
    t.gui_heartbeat_age_ns = c.housekeeping.gui_heartbeat_ns < 0
                                 ? -1
                                 : std::max<std::int64_t>(to_ns(c.now) - c.housekeeping.gui_heartbeat_ns, 0);
    t.gui_fps = c.housekeeping.gui_fps;
    t.gui_vertices = c.housekeeping.gui_vertices;
    t.state = static_cast<std::uint8_t>(c.run.state);
    t.reason = static_cast<std::uint8_t>(c.run.reason);
    t.gui_attached = c.housekeeping.gui_attached != 0 ? 1 : 0;
    t.device_state = static_cast<std::uint8_t>(c.hand[0].sample.state);
    if (c.lines.fitted) {
        t.lines = static_cast<std::uint8_t>(shown(c.lines.sample.state));
        t.lines_reason = static_cast<std::uint8_t>(reason_of(c.lines.sample.cause));
    }
    t.recomputed_fraction_mean = static_cast<float>(c.statistics.work.recomputed_fraction_mean());
    t.recomputed_fraction_least = static_cast<float>(c.statistics.work.recomputed_fraction_least());
    t.rested = static_cast<float>(c.statistics.work.rested());
    t.delay_p50_ns = f.delay_p50_ns;
    t.delay_p99_ns = f.delay_p99_ns;
    t.stiffness_n_m_max = static_cast<float>(c.bounds.stiffness_n_m);
    t.torque_n_m_rad_max = static_cast<float>(c.bounds.torque_n_m_rad);
    t.field_gain = 1.0F;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const ModelStiffness model = c.hand[i].stiffness;
        t.model_n_m = std::max(t.model_n_m, static_cast<float>(model.force_n_m));
        t.model_n_m_rad = std::max(t.model_n_m_rad, static_cast<float>(model.torque_n_m_rad));
        t.field_gain = std::min(t.field_gain, static_cast<float>(c.hand[i].field.gain()));
        t.device_notice[i] = static_cast<std::uint8_t>(c.hand[i].sample.notice);
        t.device_bus[i] = c.hand[i].sample.bus;
    }
    topic.publish(t);
}

void publish_devices(CycleState& c, Latest<DevicesTopic>& topic) noexcept {
    DevicesTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.cycle = c.cycle;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        const DeviceSample& s = h.sample;
        DeviceHand& d = t.hand[i];
        d.valid = 1;
        d.samples = s.sequence;
        d.age_ns = s.sequence > 0 ? std::max<std::int64_t>((c.now - s.taken_at).count(), 0) : -1;
        d.age_ns_most = std::max(h.age_most.count(), d.age_ns);
        d.heat = static_cast<float>(h.out.heat);
        d.force_n_max = static_cast<float>(h.chain.settings().force_n_max);
        d.force_n_continuous = static_cast<float>(h.chain.settings().force_n_continuous);
        d.winding_c = s.winding_c;
        d.winding_c_max = s.winding_c_max;
        d.motor = s.hottest_motor;
        d.state = static_cast<std::uint8_t>(s.state);
        d.read = static_cast<std::uint8_t>(h.read_status);
        h.age_most = Duration{0};
    }
    topic.publish(t);
}

void publish_lateness(const CycleState& c, Latest<LatenessTopic>& topic) noexcept {
    LatenessTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.total = c.statistics.lateness.total();
    t.max_ns = c.statistics.lateness.max_ns();
    std::copy(c.statistics.lateness.counts().begin(), c.statistics.lateness.counts().end(), t.counts);
    topic.publish(t);
}

}  // namespace tact::servo
