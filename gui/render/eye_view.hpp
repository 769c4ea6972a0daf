// View of one eye: its pose, and the frustum through its window or screen, which may be asymmetric.
#pragma once

#include <Eigen/Core>

namespace tact {

struct EyeView {
    Eigen::Matrix4f eye_from_scene, projection;  // scene: ångström, see Camera; the eye looks along -z
    float target_a = 1.0F;                       // distance to the target, for the depth cue
};

}  // namespace tact
