#include "rt/servo/record.hpp"

#include <algorithm>
#include <cstring>

#include "rt/servo/topic_fill.hpp"

namespace tact::servo {
namespace {

StartDevice introduced(const DeviceInfo& info) {
    StartDevice d{};
    std::memcpy(d.name, info.name.data(), std::min(info.name.size(), sizeof d.name - 1));
    put(d.workspace_half_m, info.workspace_half_m);
    d.force_n_max = info.force_n_max;
    d.force_n_continuous = info.force_n_continuous;
    d.torque_n_m_max = info.torque_n_m_max;
    d.stiffness_n_m_max = info.stiffness_n_m_max;
    d.position_step_m = info.position_step_m;
    return d;
}

HandTopic hand_of(const HandCycle& h, std::uint64_t step) noexcept {
    HandTopic t{};
    t.step = step;
    t.taken_at_ns = to_ns(h.sample.taken_at);
    t.sequence = h.sample.sequence;
    put(t.pos_dev_m, h.sample.T_dev_tool.p_m);
    put(t.quat_dev_tool_xyzw, h.sample.T_dev_tool.q);
    put(t.velocity_dev_m_s, h.sample.twist_dev.linear_m_s);
    put(t.angular_dev_rad_s, h.sample.twist_dev.angular_rad_s);
    t.delay_ns = h.sample.delay.count();
    put(t.force_world_n, h.shown_world.force_n);
    put(t.torque_world_n_m, h.shown_world.torque_n_m);
    put(t.force_model_world_n, h.step.wrench_world.force_n);
    put(t.torque_model_world_n_m, h.step.wrench_world.torque_n_m);
    t.model_error_n = static_cast<float>(h.step.load.error);
    t.items = h.step.load.items;
    t.buttons = h.sample.buttons;
    t.deadline_check = h.deadline.passed_at;
    t.read_status = static_cast<std::uint8_t>(h.read_status);
    t.write_status = static_cast<std::uint8_t>(h.write_status);
    t.hand_present = h.sample.hand_present ? 1 : 0;
    t.device_state = static_cast<std::uint8_t>(h.sample.state);
    t.notice = static_cast<std::uint8_t>(h.sample.notice);
    t.step_status = static_cast<std::uint8_t>(h.step.status);
    t.at_wall = (h.out.acts & kChainWall) != 0 ? 1 : 0;
    return t;
}

}  // namespace

StartTopic start_topic(const ServoSettings& settings, std::span<const HandParts> hands, bool lines) {
    StartTopic t{};
    t.period_ns = settings.free_running ? 0 : settings.period.count();
    t.hands = static_cast<std::uint32_t>(hands.size());
    t.flags = (settings.emulated ? kStartEmulated : 0U) | (lines ? kStartLines : 0U);
    put(t.pos_world_dev_m, settings.T_world_dev.p_m);
    put(t.quat_world_dev_xyzw, settings.T_world_dev.q);
    for (std::size_t i = 0; i < std::min(hands.size(), std::size(t.device)); ++i)
        t.device[i] = introduced(hands[i].info);
    return t;
}

void publish_cycle(const CycleState& c, RtRegion& region) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) region.hand[i].push(hand_of(c.hand[i], c.step));
    CycleTopic t{};
    t.step = c.step;
    t.cycle = c.cycle;
    for (std::size_t i = 0; i < c.timestamps; ++i) t.clock_ns[i] = to_ns(c.timestamp[i]);
    t.now_ns = to_ns(c.now);
    t.lateness_ns = c.lateness.count();
    t.cost_ns = c.cost.count();
    t.model_ns = c.model_cost.count();
    t.level = c.budget.fidelity;
    t.work_fraction = c.budget.work_fraction;
    if (c.lines.fitted) {
        const LinesSample& l = c.lines.sample;
        t.lines_taken_at_ns = to_ns(l.taken_at);
        t.lines_sequence = l.sequence;
        t.lines_trips = l.trips;
        t.lines_state = static_cast<std::uint8_t>(l.state);
        t.lines_cause = static_cast<std::uint8_t>(l.cause);
        t.lines_inputs = l.inputs;
        t.lines_outputs = l.outputs;
        t.flags |= kCycleLines;
    }
    if (c.dry) t.flags |= kCycleDry;
    t.run_state = static_cast<std::uint8_t>(c.run.state);
    t.run_reason = static_cast<std::uint8_t>(c.run.reason);
    t.timestamps = c.timestamps;
    region.cycles.push(t);
}

}  // namespace tact::servo
