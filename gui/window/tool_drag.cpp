#include "gui/window/tool_drag.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr float kPixelsMost = 1e4F;      // in a frame
constexpr double kSteerMost = 1.0;       // metres and radians in a frame
constexpr float kHalfTurn = 3.1415927F;  // over the height of the view, as the camera

Eigen::Vector3f in_eye_a(const DragView& view, const Vec3& model_m) {
    const Eigen::Vector3f scene_a = ((model_m - view.centre_model_m) / kAngstromM).cast<float>();
    return (view.eye.eye_from_scene * scene_a.homogeneous()).head<3>();
}

}  // namespace

std::optional<Eigen::Vector2f> ToolDrag::on_screen(const DragView& view, const Vec3& model_m) {
    const Eigen::Vector4f clip = view.eye.projection * in_eye_a(view, model_m).homogeneous();
    if (!(clip.w() > 0.0F)) return std::nullopt;
    const Eigen::Vector2f at = clip.head<2>() / clip.w();  // -1 to 1, y up
    if (!at.allFinite()) return std::nullopt;
    const PixelRect& v = view.view;
    return Eigen::Vector2f(v.x + 0.5F * (at.x() + 1.0F) * v.width, v.y + 0.5F * (1.0F - at.y()) * v.height);
}

std::optional<std::size_t> ToolDrag::tool_near(const DragView& view, std::span<const DragTool> tools, float x,
                                               float y, float within) {
    std::optional<std::size_t> nearest;
    float least = within;
    for (std::size_t i = 0; i < tools.size(); ++i) {
        if (!tools[i].may) continue;
        const auto at = on_screen(view, tools[i].at_model_m);
        if (!at) continue;
        const float off = (*at - Eigen::Vector2f(x, y)).norm();
        if (!(off <= least)) continue;
        least = off;
        nearest = i;
    }
    return nearest;
}

void ToolDrag::take(std::size_t hand, const DragTool& tool, const SceneMeta& meta, HeldBy by) {
    holds_ = true;
    by_ = by;
    hand_ = hand;
    buttons_ = 0;
    target_ = tool.T_world_tool;
    drawn_off_m_ = tool.at_model_m - meta.to_model(tool.T_world_tool.p_m);
}

void ToolDrag::move(const DragView& view, const DragMotion& motion) {
    if (!holds_) return;
    const SceneMeta& meta = *view.meta;
    buttons_ = (motion.clutch ? 1U : 0U) | (motion.drive ? 2U : 0U);
    if (!std::isfinite(motion.dx) || !std::isfinite(motion.dy) || !std::isfinite(motion.wheel) ||
        !(view.view.height > 0.0F))
        return;
    const float fine = motion.fine ? static_cast<float>(kFine) : 1.0F;
    const Quat back =
        view.q_eye_scene.conjugate().cast<double>();  // the axes of scene, model and world are parallel
    const float wheel = std::clamp(motion.wheel, -20.0F, 20.0F),
                dx = std::clamp(motion.dx, -kPixelsMost, kPixelsMost),
                dy = std::clamp(motion.dy, -kPixelsMost, kPixelsMost);
    if (motion.turn) {
        const Eigen::Vector3f turn_eye_rad =
            fine * (kHalfTurn / view.view.height * Eigen::Vector3f(dy, dx, 0.0F) +
                    Eigen::Vector3f(0.0F, 0.0F, kRollRad * wheel));
        target_.q = (quat_from_rotation_vector(back * turn_eye_rad.cast<double>()) * target_.q).normalized();
        return;
    }
    const float depth_a = std::max(-in_eye_a(view, target_model_m(meta)).z(), 0.0F);
    const float a_per_px = 2.0F * depth_a / (view.eye.projection(1, 1) * view.view.height);
    const Vec3 across_world_m =
        meta.world_per_model * kAngstromM * (fine * a_per_px * Eigen::Vector3f(dx, -dy, 0.0F)).cast<double>();
    const Vec3 away_world_m(0.0, 0.0, -kWheelM * static_cast<double>(fine * wheel));
    target_.p_m += back * (across_world_m + away_world_m);
    bound();
}

void ToolDrag::steer(const DragView& view, const Vec3& move_eye_m, const Vec3& turn_eye_rad,
                     std::uint32_t buttons) {
    if (!holds_) return;
    buttons_ = buttons & MouseTopic::kButtons;
    if (!move_eye_m.allFinite() || !turn_eye_rad.allFinite()) return;
    const Quat back = view.q_eye_scene.conjugate().cast<double>();
    const auto bounded = [](const Vec3& v) { return Vec3(v.cwiseMax(-kSteerMost).cwiseMin(kSteerMost)); };
    target_.p_m += back * bounded(move_eye_m);
    target_.q = (quat_from_rotation_vector(back * bounded(turn_eye_rad)) * target_.q).normalized();
    bound();
}

void ToolDrag::bound() { target_.p_m = target_.p_m.cwiseMax(-kReachM).cwiseMin(kReachM); }

LeadDevice ToolDrag::device() const {
    if (by_ == HeldBy::spacemouse) return LeadDevice::spacemouse;
    return by_ == HeldBy::gamepad ? LeadDevice::gamepad : LeadDevice::mouse;
}

MouseTopic ToolDrag::record(std::uint64_t generation, std::int64_t now_ns) const {
    MouseTopic t{};
    t.taken_at_ns = now_ns;
    t.generation = generation;
    std::copy_n(target_.p_m.data(), 3, t.pos_world_m);
    std::copy_n(target_.q.coeffs().data(), 4, t.quat_world_tool_xyzw);
    t.buttons = holds_ ? buttons_ : 0U;
    t.hand = static_cast<std::uint8_t>(hand_);
    t.holds = holds_ ? 1 : 0;
    t.device = static_cast<std::uint8_t>(device());
    return t;
}

}  // namespace tact
