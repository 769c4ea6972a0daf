// Models of Force Dimension, with their limits; and the axes of their frame.
//
// Source     force, torque, stiffness and radius: the figures of the open toolkit CHAI3D, whose authors
//            work with the manufacturer (devices/CDeltaDevices.cpp, version 3.2), where it lists the model.
//            It does not list sigma.3, lambda.3 and lambda.7: they get the figures of the sigma.7, the
//            weakest of the active wrists.
// Continuous no public figure: 60 % of the maximum
// Workspace  a box in the ball of that radius; along the depth, where a delta is shallow, 0.7 of the radius
// Step       a conservative figure: coarser than the manufacturer's, which are below 10 micrometres
//            (delta.3: 30)
#pragma once

#include "ipc/base/pose.hpp"

namespace tact::fd {

struct Model {
    int type;  // of dhdGetSystemType; a left-handed device has its own
    const char* name;
    double force_n_max, torque_n_m_max;  // torque 0: a wrist without motors, or no wrist
    double stiffness_n_m_max;
    double radius_m, step_m;
    double centre_m[3];  // of the workspace, in the device's own frame
};

// Null: a model that Tact has no limits for.
[[nodiscard]] const Model* model(int type) noexcept;

inline constexpr double kContinuousShare = 0.6, kDepthShare = 0.7;

// From the device's frame (x to the user, y right, z up) to Tact's (x right, y up, z to the user), and back.
[[nodiscard]] inline Vec3 tact_axes(const Vec3& v) noexcept { return {v.y(), v.z(), v.x()}; }
[[nodiscard]] inline Vec3 device_axes(const Vec3& v) noexcept { return {v.z(), v.x(), v.y()}; }

}  // namespace tact::fd
