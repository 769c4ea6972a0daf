// Transformations into the scene frame (gui/render/camera.hpp): ångström about the centre of the drawn content.
//
// Thread   any; plain arithmetic.
#pragma once

#include <Eigen/Core>

#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr float kSceneAPerM = 1e10F;

// From the body frame in ångström to the scene frame about this centre.
[[nodiscard]] Eigen::Matrix4f scene_from_body(const Pose& T_model_body, const Vec3& centre_model_m);
// From the model frame in metres.
[[nodiscard]] Eigen::Matrix4f scene_from_model(const Vec3& centre_model_m);

}  // namespace tact
