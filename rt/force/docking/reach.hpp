// Validity checks for poses of the tool and of bodies.
//
// Thread   any; constant time, no allocation.
#pragma once

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

// Largest valid distance of a tool or body from the world origin.
inline constexpr double kReachM = 10.0;

// True: finite, with a quaternion of about unit length that may need normalizing.
[[nodiscard]] inline bool is_pose(const Pose& pose) noexcept TACT_RT {
    const double turn = pose.q.norm();
    return pose.finite() && turn > 0.9 && turn < 1.1;
}

[[nodiscard]] inline bool is_in_reach(const Pose& T_world_tool) noexcept TACT_RT {
    return is_pose(T_world_tool) && T_world_tool.p_m.norm() <= kReachM;
}

[[nodiscard]] inline bool is_placeable(const SceneMeta& meta, const Pose& T_model_body) noexcept TACT_RT {
    return is_pose(T_model_body) && meta.to_world(T_model_body.p_m).norm() <= kReachM;
}

}  // namespace tact
