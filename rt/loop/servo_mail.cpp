// The servo's side of the mail: orders and models in, answers out.
#include "rt/loop/servo.hpp"

namespace tact {

namespace {

constexpr int kOrdersPerCycle = 4;

bool concerns_state(CommandKind kind) noexcept {
    return kind == CommandKind::arm || kind == CommandKind::disarm || kind == CommandKind::reset_fault;
}

}  // namespace

void Servo::take_mail(CycleState& c) noexcept {
    c.events = {};
    c.order = {};
    if (mail_.house.count() != house_seen_) {
        house_seen_ = mail_.house.count();
        static_cast<void>(mail_.house.read(c.house));
    }
    ServoOrder order{};
    for (int i = 0; i < kOrdersPerCycle && c.order.kind == 0 && mail_.orders.next(orders_, order); ++i)
        obey(c, order);

    const bool attached = c.house.gui_attached != 0;
    if (attached != gui_attached_ || (attached && c.house.gui_generation != gui_generation_)) {
        gui_attached_ = attached;
        gui_generation_ = c.house.gui_generation;
        say(attached ? EventCode::gui_attached : EventCode::gui_detached,
            static_cast<double>(gui_generation_), 0.0);
        health_due_ = true;
    }
    // A GUI that ever reported and no longer does is silent, whether it left or hangs.
    const bool silent = c.house.gui_heartbeat_ns >= 0 &&
                        c.now - instant_from_ns(c.house.gui_heartbeat_ns) > settings_.gui_silent;
    if (silent && !gui_silent_) {
        say(EventCode::gui_silent, to_us(c.now - instant_from_ns(c.house.gui_heartbeat_ns)) * 1e-3, 0.0);
    }
    gui_silent_ = silent;
    c.events.gui_silent = silent && settings_.gui_silent_ramps;
}

void Servo::obey(CycleState& c, const ServoOrder& order) noexcept {
    const auto kind = static_cast<CommandKind>(order.kind);
    const auto answer = [&](bool good) {
        acknowledge(order, good ? CommandResult::done : CommandResult::refused_value);
        if (good) ++levels_sequence_;
        publish_levels(c);
    };
    switch (kind) {
        case CommandKind::arm:
            c.events.arm = true;
            break;
        case CommandKind::disarm:
            c.events.disarm = true;
            break;
        case CommandKind::reset_fault:
            c.events.reset = true;
            break;
        case CommandKind::set_law:
            if (order.index < kLawNames.size()) governor_.set_law(static_cast<Law>(order.index));
            return answer(order.index < kLawNames.size());
        case CommandKind::set_goal_hz:
            return answer(governor_.set_goal_hz(order.value));
        case CommandKind::set_level:
            return answer(governor_.set_level(order.index, order.value));
        case CommandKind::set_fidelity_auto:
            governor_.set_law(Law::sensitus);
            return answer(true);
        case CommandKind::none:  // refused by the house thread, which says why in the index
            return acknowledge(order, static_cast<CommandResult>(order.index));
        default:  // the house thread passes on nothing else
            break;
    }
    if (concerns_state(kind)) {
        c.order = order;
    } else {
        acknowledge(order, CommandResult::unknown);
    }
}

// After the state machine has spoken.
void Servo::answer_state_order(CycleState& c, RunState before) noexcept {
    const auto kind = static_cast<CommandKind>(c.order.kind);
    if (!concerns_state(kind)) return;
    bool good = false;
    if (kind == CommandKind::arm) good = amplifier_on(c.run.state);
    if (kind == CommandKind::disarm) good = c.run.state == RunState::ready;
    if (kind == CommandKind::reset_fault) good = before == RunState::fault && c.run.state == RunState::ready;
    acknowledge(c.order, good ? CommandResult::done : CommandResult::refused_state);
}

void Servo::acknowledge(const ServoOrder& order, CommandResult result) noexcept {
    say(EventCode::command_done, static_cast<double>(order.kind), static_cast<double>(result));
    health_due_ = true;
    if (order.sequence == 0) return;
    last_sequence_ = order.sequence;
    last_result_ = result;
}

// At a cycle boundary; the new model enters with zero force and the ramp from its beginning.
void Servo::take_model(CycleState& c) noexcept {
    ForceModel* const fresh = mail_.model.take();
    if (fresh == nullptr) return;
    HandCycle& h = c.hand[0];
    ForceModel* const old = h.model;
    h.model = fresh;
    h.model->reset(h.tool);
    h.chain.restart();
    governor_.replace(kForceIndex, fresh->knob());
    mail_.model.give_back(old);
    ++levels_sequence_;
    say(EventCode::model_swapped, 0.0, 0.0);
}

void Servo::note_fault(const CycleState& c) noexcept {
    const HandCycle& h = c.hand[0];
    FaultSnapshot s{};
    s.cycle = c.cycle;
    s.taken_at_ns = to_ns(c.now);
    s.lateness_ns = c.lateness.count();
    s.sample_age_ns = (c.now - h.sample.taken_at).count();
    s.measured = c.trip.measured;
    s.reason = static_cast<std::uint64_t>(c.run.reason);
    TraceTopic last{};
    RingCursor at{.next = region_.trace.pushed(), .missed = 0};
    const bool known = at.next > 0 && region_.trace.next(at, last);
    for (int i = 0; i < 3; ++i) {
        s.pos_world_m[i] = h.tool.T_world_tool.p_m[i];
        s.velocity_world_m_s[i] = h.tool.twist_world.linear_m_s[i];
        s.wanted_n[i] = h.wanted_world.force_n[i];
        s.applied_before_n[i] = known ? static_cast<double>(last.force_world_n[i]) : 0.0;
    }
    mail_.fault.publish(s);
    say(EventCode::fault_latched, static_cast<double>(c.run.reason), c.trip.measured);
}

}  // namespace tact
