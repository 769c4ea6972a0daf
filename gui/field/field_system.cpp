#include "gui/field/field_system.hpp"

#include "gui/field/field_content.hpp"
#include "gui/render/arrow.hpp"
#include "gui/render/drawn_hand.hpp"

namespace tact {
namespace {

std::optional<Vec3> tool_model_m(const Controller& controller, const SceneContent& content) {
    if (!controller.attached() || !controller.have_tool) return std::nullopt;
    const Vec3 at = content.meta.to_model(Vec3(controller.tool.pos_world_m));
    return at.allFinite() ? std::optional(at) : std::nullopt;
}

}  // namespace

void FieldSystem::use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
                      SceneView& view, const SystemContext& context) {
    static_cast<void>(start), static_cast<void>(view);
    content_ = content;
    context.state.toggles.style = static_cast<int>(SurfaceStyle::glass);  // the tool is inside
    const FieldContent* const own = content->of<FieldContent>();
    if (own == nullptr) return;
    FieldState& f = panels_.field;
    f = {};
    f.unit = own->field.unit;
    f.low = own->field.low;
    f.high = own->field.high;
    f.force_n_max = own->field.force_n_max;
    f.stiffness_n_m = own->field.stiffness_n_m;
    f.probe_mm = 1e3 * own->field.probe_radius_m * content->meta.world_per_model;
}

void FieldSystem::close() {
    content_.reset();
    panels_.field = {};
}

void FieldSystem::follow(const SystemContext& context) {
    FieldState& f = panels_.field;
    const FieldContent* const own = content_ ? content_->of<FieldContent>() : nullptr;
    const auto at = own != nullptr ? tool_model_m(context.controller, *content_) : std::nullopt;
    f.known = at.has_value();
    if (!f.known) return;
    const FieldMeta& m = own->field;
    f.inside =
        (at->array() >= Vec3(m.box_low_m).array()).all() && (at->array() <= Vec3(m.box_high_m).array()).all();
    Vec3 gradient;
    f.potential = own->potential(*at, gradient);
    f.slope = gradient.norm();
    f.force_n = Vec3(context.controller.tool.force_model_n).norm();
}

void FieldSystem::prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) {
    static_cast<void>(now_ns), static_cast<void>(sharp);
    const auto at = tool_model_m(context.controller, *content_);
    if (!at) return;
    frame.hand = DrawnHand{{*at, Quat::Identity()},
                           Vec3(context.controller.tool.force_model_n),
                           false,
                           true,
                           kSteelColour,
                           kSteelGripColour,
                           kForceColour};
}

}  // namespace tact
