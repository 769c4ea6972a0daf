// What one eye sees: where it is, and the frustum through its window or screen, which need not be symmetric.
#pragma once

#include <Eigen/Core>

namespace tact {

struct EyeView {
    Eigen::Matrix4f eye_from_scene, projection;  // scene: ångström, see Camera; the eye looks along -z
    float target_a = 1.0F;                       // distance of what is looked at, for the depth cue
};

}  // namespace tact
