// Rigid poses, wrenches and twists, in double precision and fixed size.
//
// Frames   world  right-handed, x right, y up, z to the user; metres of the hand's motion
//         dev    haptic device; tool: the object in the hand; head: the glasses
//         model  map or mesh, metres (an EM map is about 1e-8 m wide)
//         body   atomic structure, origin in its centre of mass, axes as in its file
// Naming   T_world_tool maps tool coordinates to world, so adjacent names cancel.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tact {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Quat = Eigen::Quaterniond;

struct Pose {
    Vec3 p_m = Vec3::Zero();
    Quat q = Quat::Identity();

    [[nodiscard]] Vec3 operator*(const Vec3& point_m) const { return p_m + q * point_m; }
    [[nodiscard]] Pose operator*(const Pose& inner) const {
        return {p_m + q * inner.p_m, (q * inner.q).normalized()};
    }
    [[nodiscard]] Pose inverse() const {
        const Quat back = q.conjugate();
        return {-(back * p_m), back};
    }
    [[nodiscard]] bool finite() const { return p_m.allFinite() && q.coeffs().allFinite(); }
};

// Force at, and torque about, a stated point, in the axes of a stated frame.
struct Wrench {
    Vec3 force_n = Vec3::Zero();
    Vec3 torque_n_m = Vec3::Zero();

    [[nodiscard]] bool finite() const { return force_n.allFinite() && torque_n_m.allFinite(); }
};

struct Twist {
    Vec3 linear_m_s = Vec3::Zero();
    Vec3 angular_rad_s = Vec3::Zero();
};

// Rotation vector (axis times angle, radians, angle in [0, pi]) of a unit quaternion.
[[nodiscard]] inline Vec3 rotation_vector_rad(const Quat& q) {
    const double sign = q.w() < 0.0 ? -1.0 : 1.0;
    const Vec3 v = sign * q.vec();
    const double s = v.norm();
    if (s < 1e-12) return 2.0 * v;
    return v * (2.0 * std::atan2(s, sign * q.w()) / s);
}

[[nodiscard]] inline Quat quat_from_rotation_vector(const Vec3& r_rad) {
    const double angle = r_rad.norm();
    if (angle < 1e-12) return Quat(1.0, 0.5 * r_rad.x(), 0.5 * r_rad.y(), 0.5 * r_rad.z()).normalized();
    return Quat(Eigen::AngleAxisd(angle, r_rad / angle));
}

}  // namespace tact
