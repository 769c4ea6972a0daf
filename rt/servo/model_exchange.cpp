#include "rt/servo/model_exchange.hpp"

#include "rt/servo/fit_level.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/report.hpp"

namespace tact::servo {

namespace {

ModelOrder model_order(const ServoOrder& order) noexcept {
    using Kind = ModelOrder::Kind;
    const auto kind_of = [](CommandKind command) {
        switch (command) {
            case CommandKind::select_body:
                return Kind::select;
            case CommandKind::fix_body:
                return Kind::fix;
            case CommandKind::place_body:
                return Kind::place;
            case CommandKind::add_body:
                return Kind::add;
            case CommandKind::remove_body:
                return Kind::remove;
            default:
                return Kind::setting;
        }
    };
    ModelOrder o;
    o.kind = kind_of(static_cast<CommandKind>(order.kind));
    o.command = static_cast<std::uint8_t>(order.kind);
    o.on = order.value != 0.0;
    o.body = order.body;
    o.value = order.value;
    o.T_model_body = {Vec3(order.pos_model_m), Quat(order.quat_model_body_xyzw)};
    return o;
}

std::uint32_t id_in_hand(const ModelBodies& b) noexcept {
    return b.active < b.count ? b.id[b.active] : ModelBodies::kNone;
}

void govern_anew(CycleState& c, const ServoSettings& settings) noexcept {
    c.governor.replace(kForcePathIndex, c.hand[0].model->knob());
    make_level_rows(c);
    choose_level(c, settings);
}

// Reports changed bodies. If the hand holds another structure, restarts the governor for it.
void report_bodies(CycleState& c, const ServoSettings& settings, const ServoIo& io,
                   const ModelBodies& before) noexcept {
    const ForceModel& model = *c.hand[0].model;
    const ModelBodies now = model.bodies();
    if (now.placements != before.placements || now.options != before.options)
        report(c, io.region, EventCode::bodies_changed, static_cast<double>(now.count),
               static_cast<double>(now.options));
    if (now.tools != before.tools) {
        govern_anew(c, settings);
        ++c.report.levels_sequence;
        publish_levels(c, settings, io.region);
    }
    if (id_in_hand(now) == id_in_hand(before)) return;
    report(c, io.region, EventCode::body_selected, static_cast<double>(id_in_hand(now)),
           static_cast<double>(model.items(1.0F)));
    if (now.active < now.count && now.structure[now.active] != c.mailbox.governed_structure) {
        c.mailbox.governed_structure = now.structure[now.active];
        govern_anew(c, settings);
    }
    ++c.report.levels_sequence;
    publish_levels(c, settings, io.region);
}

void take_model(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    ForceModel* const fresh = io.mailbox.model.take();
    if (fresh == nullptr) return;
    record_mailbox(c, io.region, MailboxKind::model_taken, {});
    HandCycle& h = c.hand[0];
    ForceModel* const old = h.model;
    const ModelBodies before = old->bodies();
    h.model = fresh;
    if (!fresh->adopt(*old)) {
        fresh->reset(h.tool);
        h.chain.restart();
        govern_anew(c, settings);
        const ModelBodies now = fresh->bodies();
        if (now.active < now.count) c.mailbox.governed_structure = now.structure[now.active];
        ++c.report.levels_sequence;
    }
    io.mailbox.model.give_back(old);
    if (c.mailbox.building) io.mailbox.build.settle();
    c.mailbox.building = false;
    report(c, io.region, EventCode::model_swapped, 0.0, 0.0);
    report_bodies(c, settings, io, before);
}

void ask_for_model(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    ForceModel& model = *c.hand[0].model;
    if (c.mailbox.building && io.mailbox.build.refused()) {
        record_mailbox(c, io.region, MailboxKind::build_refused, {});
        const ModelBodies before = model.bodies();
        model.give_up();
        io.mailbox.build.settle();
        c.mailbox.building = false;
        report_bodies(c, settings, io, before);
    }
    if (!c.mailbox.building && !c.dry && model.stale())
        c.mailbox.building = io.mailbox.build.ask(model, model.bodies());
}

}  // namespace

void exchange_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    take_model(c, settings, io);
    ask_for_model(c, settings, io);
}

bool order_model(CycleState& c, const ServoSettings& settings, const ServoIo& io,
                 const ServoOrder& order) noexcept {
    ForceModel& model = *c.hand[0].model;
    const ModelBodies before = model.bodies();
    if (!model.order(model_order(order))) return false;
    report_bodies(c, settings, io, before);
    return true;
}

}  // namespace tact::servo
