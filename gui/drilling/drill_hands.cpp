#include "gui/drilling/drill_hands.hpp"

#include <cmath>
#include <numbers>

namespace tact {
namespace {

constexpr double kTurnAPictureRad = 0.23;  // over a third of the angle between two cutting edges

}  // namespace

std::span<const DrawnDrillTool> DrillHands::follow(const DrillTopic& topic, const SceneMeta& meta) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kDrillHands; ++i) {
        const DrillHand& h = topic.hand[i];
        if (h.kind == DrillKind::none) continue;
        DrawnDrillTool& d = drawn_[count++];
        const double *const p = h.pos_model_m, *const q = h.quat_model_tool_xyzw;
        d.T_model_tool = Pose{Vec3(p[0], p[1], p[2]), Quat(q[3], q[0], q[1], q[2]).normalized()};
        const double to_model = 1.0 / meta.world_per_model;
        d.radius_m = to_model * static_cast<double>(h.radius_m);
        d.length_m = to_model * static_cast<double>(h.length_m);
        d.tip_radius_m = to_model * static_cast<double>(h.tip_radius_m);
        d.shaft_radius_m = to_model * static_cast<double>(h.shaft_radius_m);
        d.shaft_length_m = to_model * static_cast<double>(h.shaft_length_m);
        d.head = h.kind == DrillKind::suction_tube ? DrillHead::tube
                 : h.shape == DrillShape::cylinder ? DrillHead::cylinder
                 : h.shape == DrillShape::cone     ? DrillHead::cone
                                                   : DrillHead::sphere;
        d.diamond = h.grit == DrillGrit::diamond;
        if (h.burr_rad_s > 0.0F)
            turned_rad_[i] = std::fmod(turned_rad_[i] + kTurnAPictureRad, 2.0 * std::numbers::pi);
        d.turned_rad = turned_rad_[i];
    }
    return std::span(drawn_).first(count);
}

}  // namespace tact
