#include "gui/surface/surface_system.hpp"

#include "gui/surface/touch_show.hpp"

namespace tact {

void SurfaceSystem::use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
                        SceneView& view, const SystemContext& context) {
    static_cast<void>(start);
    content_ = content;
    view_ = &view;
    layer_ = std::make_unique<SurfaceLayer>(content);
    view.set_layer(layer_.get());
    // A touched surface is hard; only a contour needs to show its inside.
    context.state.toggles.style = static_cast<int>(SurfaceStyle::solid);
    detail_.use(content, panels_.detail);
}

void SurfaceSystem::close() {
    if (view_ != nullptr) view_->set_layer(nullptr);
    view_ = nullptr;
    layer_.reset();
    content_.reset();
    detail_ = {};
    panels_.detail = {};
}

// On the surface where it touches, though the hand is below it.
std::optional<Vec3> SurfaceSystem::tool_at(std::size_t hand, const SystemContext& context) const {
    const auto pen = hand == 0 ? touching_pen(context.controller, *content_) : std::nullopt;
    return pen ? std::optional(pen->T_model_hand.p_m) : std::nullopt;
}

void SurfaceSystem::prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) {
    static_cast<void>(now_ns), static_cast<void>(sharp);
    const Controller& controller = context.controller;
    SceneToggles& t = context.state.toggles;
    if (const auto pen = touching_pen(controller, *content_)) frame.hand = pen;
    const bool touched = controller.attached() && controller.have_touch;
    if (const auto made = detail_.follow(touched ? &controller.touch : nullptr, t.detail, panels_.detail,
                                         context.state.requests))
        layer_->show_detail(*made);
    layer_->frame = {t.detail && t.surface, touching_tool(controller, *content_), {}};
    if (t.force) layer_->frame.touch = touch_marks(controller);
}

bool SurfaceSystem::add_to_key(ContentKey& key) const {
    const SurfaceLayer::Frame& f = layer_->frame;
    if (f.detail || f.touch) return false;  // the contact and the detail around it change with the hand
    if (f.T_model_tool) key.add(*f.T_model_tool);
    return true;
}

}  // namespace tact
