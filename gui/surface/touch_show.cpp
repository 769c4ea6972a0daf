#include "gui/surface/touch_show.hpp"

#include "gui/render/arrow.hpp"
#include "gui/surface/surface_content.hpp"

namespace tact {
namespace {

const TouchTool* tool_of(const SceneContent& content) {
    const SurfaceContent* const surface = content.of<SurfaceContent>();
    return surface != nullptr ? surface->tool.get() : nullptr;
}

}  // namespace

std::optional<DrawnHand> touching_pen(const Controller& controller, const SceneContent& content) {
    if (!controller.attached() || !controller.have_tool || !controller.have_bodies ||
        controller.bodies.count == 0)
        return std::nullopt;
    const double *const p = controller.bodies.body[0].pos_model_m, *const f = controller.tool.force_model_n;
    const Vec3 tip(p[0], p[1], p[2]), force(f[0], f[1], f[2]);
    if (!tip.allFinite() || !force.allFinite()) return std::nullopt;
    return DrawnHand{{tip, Quat::Identity()}, force,       false, tool_of(content) == nullptr, kSteelColour,
                     kSteelGripColour,        kForceColour};
}

std::optional<Pose> touching_tool(const Controller& controller, const SceneContent& content) {
    if (tool_of(content) == nullptr || !controller.attached() || !controller.have_bodies ||
        controller.bodies.count == 0)
        return std::nullopt;
    const auto& body = controller.bodies.body[0];
    const double *const p = body.pos_model_m, *const q = body.quat_model_body_xyzw;
    const Pose pose{{p[0], p[1], p[2]}, Quat(q[3], q[0], q[1], q[2]).normalized()};
    return pose.finite() ? std::optional(pose) : std::nullopt;
}

std::optional<DrawnTouch> touch_marks(const Controller& controller) {
    if (!controller.attached() || !controller.have_touch) return std::nullopt;
    const TouchTopic& t = controller.touch;
    const auto vec = [](const auto& v) {
        return Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
    };
    DrawnTouch drawn{vec(t.probe_model_m), vec(t.proxy_model_m), t.radius_model_m, t.planes, {}, {}};
    for (std::uint32_t i = 0; i < t.planes; ++i) {
        drawn.normal[i] = vec(t.normal_model[i]);
        drawn.push_n[i] = static_cast<double>(t.push_n[i]);
    }
    return drawn;
}

}  // namespace tact
