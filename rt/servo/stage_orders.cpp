#include "rt/servo/stage_orders.hpp"

#include "rt/servo/model_exchange.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/report.hpp"

namespace tact::servo {

namespace {

constexpr int kOrdersPerCycle = 4;

bool concerns_state(CommandKind kind) noexcept {
    return kind == CommandKind::arm || kind == CommandKind::disarm || kind == CommandKind::reset_fault;
}

// Applies an order that sets law, goal or level.
bool order_governor(CycleState& c, const ServoSettings& settings, const ServoOrder& order) noexcept {
    switch (static_cast<CommandKind>(order.kind)) {
        case CommandKind::set_law:
            if (order.index < kLawNames.size()) c.governor.set_law(static_cast<Law>(order.index));
            return order.index < kLawNames.size();
        case CommandKind::set_goal_hz:
            return c.governor.set_goal_hz(order.value);
        case CommandKind::set_level:
            return c.governor.set_level(order.index, order.value);
        default:  // set_fidelity_auto
            c.governor.set_law(settings.governor.law == Law::fixed ? kDefaultLaw : settings.governor.law);
            return true;
    }
}

void apply(CycleState& c, const ServoSettings& settings, const ServoIo& io,
           const ServoOrder& order) noexcept {
    const auto result = [](bool good) { return good ? CommandResult::done : CommandResult::refused_value; };
    const auto kind = static_cast<CommandKind>(order.kind);
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
        case CommandKind::set_goal_hz:
        case CommandKind::set_level:
        case CommandKind::set_fidelity_auto: {
            const bool good = order_governor(c, settings, order);
            acknowledge(c, io.region, order, result(good));
            if (good) ++c.report.levels_sequence;
            return publish_levels(c, settings, io.region);
        }
        case CommandKind::mark:
            return acknowledge(c, io.region, order, CommandResult::done);
        case CommandKind::none:  // refused by the housekeeping thread, with the result as index
            return acknowledge(c, io.region, order, static_cast<CommandResult>(order.index));
        default:
            if (is_for_model(kind))
                return acknowledge(c, io.region, order, result(order_model(c, settings, io, order)));
            return acknowledge(c, io.region, order, CommandResult::unknown);
    }
    c.order = order;
}

// An arm that is pending together with a disarm is refused, whichever was ordered first.
void take_state_order(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    ServoOrder disarm{}, arm{};
    const bool disarms = io.mailbox.orders.take(CommandKind::disarm, disarm);
    const bool arms = io.mailbox.orders.take(CommandKind::arm, arm);
    if (arms) record_mailbox(c, io.region, MailboxKind::order, arm);
    if (disarms) record_mailbox(c, io.region, MailboxKind::order, disarm);
    if (arms && disarms) c.mailbox.refused_arm = arm;
    if (arms || disarms) apply(c, settings, io, disarms ? disarm : arm);
}

void watch_gui(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept {
    MailboxCycle& m = c.mailbox;
    const bool attached = c.housekeeping.gui_attached != 0;
    if (attached != m.gui_attached || (attached && c.housekeeping.gui_generation != m.gui_generation)) {
        m.gui_attached = attached;
        m.gui_generation = c.housekeeping.gui_generation;
        report(c, region, attached ? EventCode::gui_attached : EventCode::gui_detached,
               static_cast<double>(m.gui_generation), 0.0);
        c.report.health_due = true;
    }
    const bool silent = c.housekeeping.gui_heartbeat_ns >= 0 &&
                        c.now - instant_from_ns(c.housekeeping.gui_heartbeat_ns) > settings.gui_silent;
    if (silent && !m.gui_silent) {
        report(c, region, EventCode::gui_silent,
               to_us(c.now - instant_from_ns(c.housekeeping.gui_heartbeat_ns)) * 1e-3, 0.0);
    }
    m.gui_silent = silent;
    c.events.gui_silent = silent && settings.gui_silent_ramps;
}

}  // namespace

void take_orders(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    c.events = {};
    c.order = {};
    c.mailbox.refused_arm = {};
    if (io.mailbox.housekeeping.count() != c.mailbox.reports_seen) {
        c.mailbox.reports_seen = io.mailbox.housekeeping.count();
        if (io.mailbox.housekeeping.read(c.housekeeping))
            io.region.reports.push({.step = c.step, .said = c.housekeeping});
    }
    take_state_order(c, settings, io);
    ServoOrder order{};
    for (int i = 0;
         i < kOrdersPerCycle && c.order.kind == 0 && io.mailbox.orders.next(c.mailbox.orders, order); ++i) {
        record_mailbox(c, io.region, MailboxKind::order, order);
        apply(c, settings, io, order);
    }
    watch_gui(c, settings, io.region);
}

void answer_state_order(CycleState& c, RunState before, RtRegion& region) noexcept {
    const auto kind = static_cast<CommandKind>(c.order.kind);
    if (!concerns_state(kind)) return;
    bool good = false;
    if (kind == CommandKind::arm) good = amplifier_on(c.run.state);
    if (kind == CommandKind::disarm) good = c.run.state == RunState::ready;
    if (kind == CommandKind::reset_fault) good = before == RunState::fault && c.run.state == RunState::ready;
    // The last answer is that to the newest order.
    const ServoOrder& arm = c.mailbox.refused_arm;
    const bool arm_is_newer = arm.sequence > c.order.sequence;
    if (arm.kind != 0 && !arm_is_newer) acknowledge(c, region, arm, CommandResult::refused_state);
    acknowledge(c, region, c.order, good ? CommandResult::done : CommandResult::refused_state);
    if (arm.kind != 0 && arm_is_newer) acknowledge(c, region, arm, CommandResult::refused_state);
}

}  // namespace tact::servo
