// The servo's side of the mail: orders and models in, answers out.
#include "rt/servo/servo.hpp"

namespace tact {

namespace {

constexpr int kOrdersPerCycle = 4;

ModelOrder model_order(const ServoOrder& order) noexcept {
    using Kind = ModelOrder::Kind;
    ModelOrder o;
    o.body = order.body;
    o.on = order.value != 0.0;
    o.T_model_body = {Vec3(order.pos_model_m), Quat(order.quat_model_body_xyzw)};
    o.kind = Kind::option;
    switch (static_cast<CommandKind>(order.kind)) {
        case CommandKind::select_body:
            o.kind = Kind::select;
            break;
        case CommandKind::fix_body:
            o.kind = Kind::fix;
            break;
        case CommandKind::place_body:
            o.kind = Kind::place;
            break;
        case CommandKind::add_body:
            o.kind = Kind::add;
            break;
        case CommandKind::remove_body:
            o.kind = Kind::remove;
            break;
        case CommandKind::set_clash:
            o.option = kOptionClash;
            break;
        case CommandKind::set_subtraction:
            o.option = kOptionSubtraction;
            break;
        case CommandKind::set_laplacian:
            o.option = kOptionLaplacian;
            break;
        case CommandKind::set_detail_filter:
            o.kind = Kind::filter;
            o.shape = static_cast<std::uint8_t>(order.body);
            o.width = static_cast<float>(order.value);
            o.error_far = static_cast<float>(order.pos_model_m[0]);
            break;
        default:  // no order to a model: no option, and refused
            break;
    }
    return o;
}

std::uint32_t id_in_hand(const ModelBodies& b) noexcept {
    return b.active < b.count ? b.id[b.active] : ModelBodies::kNone;
}

bool concerns_state(CommandKind kind) noexcept {
    return kind == CommandKind::arm || kind == CommandKind::disarm || kind == CommandKind::reset_fault;
}

}  // namespace

void Servo::read_mailbox(CycleState& c) noexcept {
    c.events = {};
    c.order = {};
    if (mailbox_.housekeeping.count() != housekeeping_seen_) {
        housekeeping_seen_ = mailbox_.housekeeping.count();
        if (mailbox_.housekeeping.read(c.housekeeping))
            region_.reports.push({.step = c.step, .said = c.housekeeping});
    }
    ServoOrder order{};
    for (int i = 0; i < kOrdersPerCycle && c.order.kind == 0 && mailbox_.orders.next(orders_, order); ++i) {
        record_mailbox(MailboxKind::order, order);
        apply(c, order);
    }

    const bool attached = c.housekeeping.gui_attached != 0;
    if (attached != gui_attached_ || (attached && c.housekeeping.gui_generation != gui_generation_)) {
        gui_attached_ = attached;
        gui_generation_ = c.housekeeping.gui_generation;
        report(attached ? EventCode::gui_attached : EventCode::gui_detached,
               static_cast<double>(gui_generation_), 0.0);
        health_due_ = true;
    }
    // A GUI that ever reported and no longer does is silent, whether it left or hangs.
    const bool silent = c.housekeeping.gui_heartbeat_ns >= 0 &&
                        c.now - instant_from_ns(c.housekeeping.gui_heartbeat_ns) > settings_.gui_silent;
    if (silent && !gui_silent_) {
        report(EventCode::gui_silent, to_us(c.now - instant_from_ns(c.housekeeping.gui_heartbeat_ns)) * 1e-3,
               0.0);
    }
    gui_silent_ = silent;
    c.events.gui_silent = silent && settings_.gui_silent_ramps;
}

void Servo::apply(CycleState& c, const ServoOrder& order) noexcept {
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
            governor_.set_law(settings_.governor.law == Law::fixed ? kDefaultLaw : settings_.governor.law);
            return answer(true);
        case CommandKind::mark:
            return acknowledge(order, CommandResult::done);
        case CommandKind::none:  // refused by the house thread, which says why in the index
            return acknowledge(order, static_cast<CommandResult>(order.index));
        case CommandKind::select_body:
        case CommandKind::fix_body:
        case CommandKind::place_body:
        case CommandKind::add_body:
        case CommandKind::remove_body:
        case CommandKind::set_clash:
        case CommandKind::set_subtraction:
        case CommandKind::set_laplacian:
        case CommandKind::set_detail_filter:
            return acknowledge(order,
                               order_bodies(c, order) ? CommandResult::done : CommandResult::refused_value);
    }
    if (concerns_state(kind)) {
        c.order = order;
    } else {
        acknowledge(order, CommandResult::unknown);
    }
}

// The model knows which bodies there are, and refuses others. A body of another structure is another load: it
// enters at a level that fits, and the governor goes on from there.
bool Servo::order_bodies(CycleState& c, const ServoOrder& order) noexcept {
    ForceModel& model = *c.hand[0].model;
    const ModelBodies before = model.bodies();
    if (!model.order(model_order(order))) return false;
    tell_bodies(c, before);
    return true;
}

// What changed is said and, where the hand holds another structure, governed anew.
void Servo::tell_bodies(CycleState& c, const ModelBodies& before) noexcept {
    const ForceModel& model = *c.hand[0].model;
    const ModelBodies now = model.bodies();
    if (now.placements != before.placements || now.options != before.options)
        report(EventCode::bodies_changed, static_cast<double>(now.count), static_cast<double>(now.options));
    if (id_in_hand(now) == id_in_hand(before)) return;
    report(EventCode::body_selected, static_cast<double>(id_in_hand(now)),
           static_cast<double>(model.items(1.0F)));
    if (now.active < now.count && now.structure[now.active] != governed_structure_) {
        governed_structure_ = now.structure[now.active];
        governor_.replace(kForceIndex, model.knob());
    }
    ++levels_sequence_;
    publish_levels(c);
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
    report(EventCode::command_done, static_cast<double>(order.kind), static_cast<double>(result));
    health_due_ = true;
    if (order.sequence == 0) return;
    last_sequence_ = order.sequence;
    last_result_ = result;
}

// At a cycle boundary. A model that was rebuilt goes on where the old one was; any other enters with zero
// force and the ramp from its beginning.
void Servo::take_model(CycleState& c) noexcept {
    ForceModel* const fresh = mailbox_.model.take();
    if (fresh == nullptr) return;
    record_mailbox(MailboxKind::model_taken, {});
    HandCycle& h = c.hand[0];
    ForceModel* const old = h.model;
    const ModelBodies before = old->bodies();
    h.model = fresh;
    if (!fresh->adopt(*old)) {
        fresh->reset(h.tool);
        h.chain.restart();
        governor_.replace(kForceIndex, fresh->knob());
        const ModelBodies now = fresh->bodies();
        if (now.active < now.count) governed_structure_ = now.structure[now.active];
        ++levels_sequence_;
    }
    mailbox_.model.give_back(old);
    if (building_) mailbox_.build.settle();
    building_ = false;
    report(EventCode::model_swapped, 0.0, 0.0);
    tell_bodies(c, before);
}

// One at a time: what is ordered while a model is being built is asked for after it has come.
void Servo::ask_for_model(CycleState& c) noexcept {
    ForceModel& model = *c.hand[0].model;
    if (building_ && mailbox_.build.refused()) {
        record_mailbox(MailboxKind::build_refused, {});
        const ModelBodies before = model.bodies();
        model.give_up();
        mailbox_.build.settle();
        building_ = false;
        tell_bodies(c, before);
    }
    if (!building_ && !dry_ && model.stale()) building_ = mailbox_.build.ask(model, model.bodies());
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
    mailbox_.fault.publish(s);
    report(EventCode::fault_latched, static_cast<double>(c.run.reason), c.trip.measured);
}

}  // namespace tact
