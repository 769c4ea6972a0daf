// Orders of the user to a docking model: options, bodies and places found. Each takes constant time; the old force fades out, then the
// new one fades in.
#include <algorithm>
#include <typeinfo>

#include "ipc/topics/command.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/docking/reach.hpp"

namespace tact {
namespace {

static_assert(kModesMax == kShapeModesMax);

// Need no other density; the last one changes no force at once.
constexpr std::uint32_t kInstantOptions = kDockingClash | kDockingPull | kDockingFlexible | kDockingTogether;

// 0: a command for another system.
std::uint32_t option_of(std::uint8_t command) noexcept {
    switch (static_cast<CommandKind>(command)) {
        case CommandKind::set_clash:
            return kDockingClash;
        case CommandKind::set_subtraction:
            return kDockingSubtraction;
        case CommandKind::set_laplacian:
            return kDockingLaplacian;
        case CommandKind::set_pull:
            return kDockingPull;
        case CommandKind::set_flexible:
            return kDockingFlexible;
        case CommandKind::set_together:
            return kDockingTogether;
        default:
            return 0;
    }
}

}  // namespace

// Fades the present wrench out; the new force then fades in.
void DockingModel::fade(const ForceFade& shown) noexcept {
    fade_.follow(shown);
    glide_.restart();
    audit_.restart();
    stiffness_audit_.restart();
    stepped_ = false;
}

// Fades as above; the next good step takes a new grip.
void DockingModel::let_go() noexcept {
    fade(fade_);
    clutched_ = true;
}

// Selects the map with the requested options, if it exists. A map made with another body in the hand has the present
// body subtracted, so it must not be used. True: the map changed.
bool DockingModel::choose_density() noexcept {
    const ForceMap* const before = force_map_;
    const std::uint32_t asked = bodies_.list().options_asked & kForceMapOptions;
    const bool fits =
        (built_->options & kDockingSubtraction) == 0 || built_->active_id == bodies_.active_id();
    if (fits && built_->options == asked) {
        force_map_ = built_.get();
    } else if (!fits || whole_->options == asked) {
        force_map_ = whole_.get();
    }
    show_options();
    return force_map_ != before;
}

void DockingModel::show_options() noexcept {
    ModelBodies& list = bodies_.list();
    list.options = force_map_->options | (list.options_asked & kInstantOptions);
    list.places = basins_.body() == bodies_.active_id() ? basins_.count() : 0;
}

bool DockingModel::set_options(std::uint32_t options, bool on) noexcept {
    if ((options & ~(kForceMapOptions | kInstantOptions)) != 0 || options == 0) return false;
    std::uint32_t& asked = bodies_.list().options_asked;
    const std::uint32_t before = asked;
    asked = on ? asked | options : asked & ~options;
    const std::uint32_t changed = before ^ asked;
    if ((changed & kDockingTogether) != 0) ++bodies_.list().others;  // others are subtracted now
    const bool another = choose_density();
    const bool other_clash = (changed & kDockingTogether) != 0 && (asked & kDockingClash) != 0;
    if (another || other_clash || (changed & (kDockingClash | kDockingPull)) != 0) fade(fade_);
    return true;
}

// Places of the body in the hand change its force.
bool DockingModel::order_pull(const ModelOrder& order) noexcept {
    const bool pulled = is_pulled();
    if (static_cast<CommandKind>(order.command) == CommandKind::clear_found_places) {
        basins_.clear();
    } else {
        const ModelBodies& list = bodies_.list();
        const bool known = std::find(list.id.begin(), list.id.begin() + list.count, order.body) !=
                           list.id.begin() + list.count;
        if (!known || !is_placeable(parts_->meta, order.T_model_body)) return false;
        if (!(order.value >= 0.0 && order.value <= 1.0)) return false;
        if (!basins_.add(order.body, {order.T_model_body.p_m, order.T_model_body.q.normalized()},
                         order.value))
            return false;
    }
    if (pulled || is_pulled()) fade(fade_);
    show_options();
    return true;
}

bool DockingModel::order(const ModelOrder& order) noexcept {
    if (order.kind == ModelOrder::Kind::setting) {
        const auto command = static_cast<CommandKind>(order.command);
        if (command == CommandKind::add_found_place || command == CommandKind::clear_found_places)
            return order_pull(order);
        return set_options(option_of(order.command), order.on);
    }
    ModelOrder checked = order;
    if (order.kind == ModelOrder::Kind::place || order.kind == ModelOrder::Kind::add) {
        if (!is_placeable(parts_->meta, order.T_model_body)) return false;
        checked.T_model_body.q.normalize();
    }
    const DockingBodies::Change change = bodies_.order(checked);
    if (order.kind == ModelOrder::Kind::remove) flexible_.forget_removed(bodies_.list());
    switch (change) {
        case DockingBodies::Change::refused:
            return false;
        case DockingBodies::Change::moved:
            let_go();
            break;
        case DockingBodies::Change::taken:
            let_go();
            static_cast<void>(choose_density());
            break;
        case DockingBodies::Change::others:
            if ((bodies_.list().options & kDockingClash) != 0) fade(fade_);
            break;
        case DockingBodies::Change::none:
            break;
    }
    return true;
}

bool DockingModel::stale() const noexcept {
    if (!bodies_.in_hand()) return false;
    const std::uint32_t asked = bodies_.list().options_asked & kForceMapOptions;
    if (asked != force_map_->options) return true;
    return (asked & kDockingSubtraction) != 0 && force_map_->others != bodies_.list().others;
}

std::unique_ptr<ForceModel> DockingModel::rebuild(const ModelBodies& bodies) const {
    return std::unique_ptr<ForceModel>(new DockingModel(*this, bodies));
}

bool DockingModel::adopt(const ForceModel& old) noexcept {
    if (typeid(old) != typeid(*this)) return false;
    const auto& before = static_cast<const DockingModel&>(old);
    if (before.parts_ != parts_) return false;
    bodies_ = before.bodies_;
    com_from_tool_world_m_ = before.com_from_tool_world_m_;
    q_tool_body_ = before.q_tool_body_;
    clutched_ = before.clutched_;  // keeps the state of the clutch
    error_scale_ = before.error_scale_;
    bends_scale_ = before.bends_scale_;
    basins_ = before.basins_;
    flexible_.take_shapes(before.flexible_);
    fade(before.fade_);
    static_cast<void>(choose_density());
    return true;
}

void DockingModel::publish(const ModelCycle& cycle) noexcept {
    const bool may_bend = std::any_of(parts_->flexible.begin(), parts_->flexible.end(),
                                      [](const FlexibleParts& parts) { return parts.bends(); });
    if (topic_ == nullptr || !may_bend) return;
    ShapesTopic t{};
    t.taken_at_ns = to_ns(cycle.now);
    t.cycle = cycle.cycle;
    t.strain = static_cast<float>(flexible_.strain());
    t.strain_most = static_cast<float>(StrainLimit::kMost);
    t.bends = is_flexible() ? 1 : 0;
    std::size_t row = 0;
    for (const BodyShape& shape : flexible_.shapes()) {
        if (shape.id == 0) continue;
        if (shape.id == bodies_.active_id()) t.rmsd_m = static_cast<float>(shape.rmsd_m());
        t.body[row].id = shape.id;
        std::copy(shape.amplitude_m.begin(), shape.amplitude_m.end(), t.body[row].amplitude_m);
        ++row;
    }
    topic_->publish(t);
}

void DockingModel::give_up() noexcept {
    // The present map stays, unless it was made for another body in the hand or for other bodies around it.
    const bool stays =
        (force_map_->options & kDockingSubtraction) == 0 ||
        (force_map_->active_id == bodies_.active_id() && force_map_->others == bodies_.list().others);
    const std::uint32_t felt = stays ? force_map_->options : whole_->options;
    bodies_.list().options_asked = felt | (bodies_.list().options_asked & kInstantOptions);
    if (choose_density()) fade(fade_);
}

}  // namespace tact
