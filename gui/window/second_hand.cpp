#include "gui/window/second_hand.hpp"

namespace tact {

void SecondHand::follow(const ToolTopic& tool) {
    const double* const p = tool.pos_world_m;
    Quat q;
    for (int i = 0; i < 4; ++i) q.coeffs()[i] = tool.quat_world_tool_xyzw[i];
    predictor_.add(tool.taken_at_ns, {Vec3(p[0], p[1], p[2]), q.normalized()});
    force_world_n_ = Vec3(tool.force_world_n[0], tool.force_world_n[1], tool.force_world_n[2]);
    at_wall_ = tool.at_wall != 0;
}

std::optional<DrawnHand> SecondHand::at(std::int64_t now_ns, const SceneMeta& scene) const {
    if (!predictor_.known()) return std::nullopt;
    const Pose world = predictor_.at(now_ns);
    return DrawnHand{{scene.to_model(world.p_m), world.q}, force_world_n_, at_wall_};
}

}  // namespace tact
