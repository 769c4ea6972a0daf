// Side view, turret at 0, the user on the right:
//
//        y |                  elbow
//          |          thigh .-'o
//          |         l1  .-'    \   shin l2          q2: thigh above the horizontal
//          |         .-'         \                   q3: shin from the vertical
//          |     .-'  q2       q3 \   (here above 0)
//          o -'- - - - - - - - - - o tip - - - z
//       shoulder
//
// Tip. In the plane of the arm, from the shoulder: forward A = l1 cos q2 + l2 sin q3, up Y = l1 sin q2 - l2
// cos q3. The turret rotates that plane by q1 about y, to the left: p = (-A sin q1, Y, A cos q1). In the reset
// pose p is (0, -l2, l1); relative to it and to the device origin, the tip is p + (0, l2, -l1) - origin.
//
// Jacobian. Columns are the derivatives by q1, q2, q3:
//     (-A c1, 0, -A s1),  (l1 s2 s1, l1 c2, -l1 s2 c1),  (-l2 c3 s1, l2 s3, l2 c3 c1),
// det J = A l1 l2 cos(q3 - q2): singular with the tip above the shoulder, and with the arm stretched or
// folded.
//
// Inverse. A = |(x, z)|, since the tip is in front of the turret; q1 = atan2(-x, z). With d = q3 - q2
//     A + iY = e^(i q2) (l1 + l2 sin d - i l2 cos d),   so   A^2 + Y^2 = l1^2 + l2^2 + 2 l1 l2 sin d.
// Elbow up is cos d > 0; then q2 = atan2(Y, A) + atan2(l2 cos d, l1 + l2 sin d). Published inverses write the
// same as two arc cosines of the triangle's sides, in a frame with x forward, y left, z up: with h^2 = A^2
// + Y^2 their elbow angle is d + pi/2, and their angle at the shoulder is the second atan2. This form needs
// no division by h and loses no digits where an arc cosine is steep.
//
// (0,-1,0) goes to (0, -c3, s3). Then the wrist: R = Ry(-q1) Rx(-q3) Ry(q4) Rx(-q5) Rz(-q6). The joints
// rotate the stylus about -y (q1), not at all (q2: the linkage keeps the shin's direction), about -Ry(-q1) x (q3)
// and about the wrist's three axes. These are the lower half of the 6 x 6 Jacobian, so a torque at the stylus also
// loads the turret and the shin. A published J^T F without these two terms is right for forces only.
//
// Virtual work: with v = J q', tau = J^T w does tau . q' = w . v. J^T needs no inverse, so nothing grows near
// At a singular configuration, the links carry the force along the direction in which the tip cannot move, and the
// hand does not feel it. So no force has to be faded out, and every other direction stays exact.
//
// Weight. Potential energy U = k2 sin q2 - k3 cos q3 + m g y, so the joints exert (0, (k2 + m g l1) cos q2,
// (k3 + m g l2) sin q3) to hold it. With the masses of the links as published for a Premium 1.5
//     k2 = g (l1 (2 m_a + m_c) + 2 l5 m_be) / 2 = -0.0163,   k3 = g (l2 m_a + 2 l3 m_c - 2 l6 m_df) / 2 =
//     -0.0738 N m:
// the counterweights are a little too heavy for the bare arm; a gimbal at the tip balances them.
#include "hal/arm/arm_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {

namespace {

constexpr double kGravity = 9.80665;
constexpr double kNearSingular = 0.1;

using Eigen::AngleAxisd;

Quat about_x(double angle) noexcept { return Quat(std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0, 0.0); }
Quat about_y(double angle) noexcept { return Quat(std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0); }
Quat about_z(double angle) noexcept { return Quat(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)); }

Quat shin_frame(const Joint6& q) noexcept { return about_y(-q[0]) * about_x(-q[2]); }

double wrapped(double angle) noexcept { return std::remainder(angle, 2.0 * std::numbers::pi); }

double overshoot(double v, double low, double high) noexcept { return std::max(low - v, v - high); }

}  // namespace

Joint6 ArmKinematics::angles_rad(const Counts6& counts, const Counts6& zero) const noexcept {
    Joint6 q;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto j = static_cast<Eigen::Index>(i);
        const auto steps = static_cast<double>(std::int64_t{counts[i]} - std::int64_t{zero[i]});
        q[j] = p_.calibration_rad[j] + steps * p_.rad_per_count[j];
    }
    return q;
}

Counts6 ArmKinematics::counts(const Joint6& q, const Counts6& zero) const noexcept {
    Counts6 counts{};
    for (std::size_t i = 0; i < 6; ++i) {
        const auto j = static_cast<Eigen::Index>(i);
        if (p_.rad_per_count[j] == 0.0 || !std::isfinite(q[j])) continue;
        const double at = zero[i] + std::round((q[j] - p_.calibration_rad[j]) / p_.rad_per_count[j]);
        counts[i] = static_cast<std::int32_t>(std::clamp(at, -2147483648.0, 2147483647.0));
    }
    return counts;
}

Vec3 ArmKinematics::tip_m(const Joint6& q) const noexcept {
    const double reach = p_.thigh_m * std::cos(q[1]) + p_.shin_m * std::sin(q[2]);
    const double up = p_.thigh_m * std::sin(q[1]) - p_.shin_m * std::cos(q[2]);
    return Vec3(-reach * std::sin(q[0]), up + p_.shin_m, reach * std::cos(q[0]) - p_.thigh_m) - p_.origin_m;
}

Pose ArmKinematics::pose(const Joint6& q) const noexcept {
    if (p_.wrist == Wrist::none) return {tip_m(q), Quat::Identity()};
    const Quat turn = shin_frame(q) * about_y(q[3]) * about_x(-q[4]) * about_z(-q[5]);
    return {tip_m(q), turn.normalized()};
}

Jacobian3 ArmKinematics::jacobian(const Joint6& q) const noexcept {
    const double s1 = std::sin(q[0]), c1 = std::cos(q[0]), s2 = std::sin(q[1]), c2 = std::cos(q[1]);
    const double s3 = std::sin(q[2]), c3 = std::cos(q[2]), l1 = p_.thigh_m, l2 = p_.shin_m;
    const double reach = l1 * c2 + l2 * s3;
    Jacobian3 j;
    j.col(0) = Vec3(-reach * c1, 0.0, -reach * s1);
    j.col(1) = l1 * Vec3(s2 * s1, c2, -s2 * c1);
    j.col(2) = l2 * Vec3(-c3 * s1, s3, c3 * c1);
    return j;
}

Jacobian6 ArmKinematics::jacobian6(const Joint6& q) const noexcept {
    Jacobian6 j = Jacobian6::Zero();
    j.topLeftCorner<3, 3>() = jacobian(q);
    if (p_.wrist == Wrist::none) return j;
    j.block<3, 1>(3, 0) = -Vec3::UnitY();
    j.block<3, 1>(3, 2) = -Vec3(std::cos(q[0]), 0.0, std::sin(q[0]));
    Quat frame = shin_frame(q);
    j.block<3, 1>(3, 3) = frame * Vec3::UnitY();
    frame = frame * about_y(q[3]);
    j.block<3, 1>(3, 4) = -(frame * Vec3::UnitX());
    frame = frame * about_x(-q[4]);
    j.block<3, 1>(3, 5) = -(frame * Vec3::UnitZ());
    return j;
}

Twist ArmKinematics::twist(const Joint6& q, const Joint6& rad_s) const noexcept {
    const Joint6 v = jacobian6(q) * rad_s;
    return {v.head<3>(), v.tail<3>()};
}

bool ArmKinematics::inverse(const Pose& T_dev_tool, Joint6& q) const noexcept {
    const double l1 = p_.thigh_m, l2 = p_.shin_m;
    const Vec3 tip = T_dev_tool.p_m + p_.origin_m + Vec3(0.0, -l2, l1);
    const double reach = std::hypot(tip.x(), tip.z());
    const double sine = (reach * reach + tip.y() * tip.y() - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
    const double sin_d = std::clamp(sine, -1.0, 1.0), cos_d = std::sqrt((1.0 - sin_d) * (1.0 + sin_d));
    q[0] = std::atan2(-tip.x(), tip.z());
    q[1] = std::atan2(tip.y(), reach) + std::atan2(l2 * cos_d, l1 + l2 * sin_d);
    q[2] = q[1] + std::atan2(sin_d, cos_d);
    q.tail<3>().setZero();
    if (p_.wrist != Wrist::none) {
        const Eigen::Matrix3d m = (shin_frame(q).conjugate() * T_dev_tool.q).toRotationMatrix();
        const double cos_b = std::hypot(m(0, 2), m(2, 2));
        q[4] = std::atan2(m(1, 2), cos_b);
        if (cos_b > 1e-9) {
            q[3] = std::atan2(m(0, 2), m(2, 2));
            q[5] = std::atan2(-m(1, 0), m(1, 1));
        } else {  // yaw and roll share one axis; the yaw takes the whole angle
            q[3] = std::atan2(-m(2, 0), m(0, 0));
        }
        // The same rotation with the pitch beyond 90 degrees.
        const Vec3 other(wrapped(q[3] + std::numbers::pi), wrapped(std::numbers::pi - q[4]),
                         wrapped(q[5] + std::numbers::pi));
        const auto worst = [this](const Vec3& w) {
            double most = -1e9;
            for (Eigen::Index i = 0; i < 3; ++i) {
                most = std::max(most, overshoot(w[i], p_.low_rad[3 + i], p_.high_rad[3 + i]));
            }
            return most;
        };
        if (worst(q.tail<3>()) > 0.0 && worst(other) <= 0.0) q.tail<3>() = other;
    }
    return std::abs(sine) <= 1.0 && T_dev_tool.finite();
}

Joint6 ArmKinematics::torque_n_m(const Joint6& q, const Wrench& wrench_dev) const noexcept {
    Joint6 w;
    w << wrench_dev.force_n, (p_.wrist == Wrist::driven ? wrench_dev.torque_n_m : Vec3(Vec3::Zero()));
    Joint6 tau = jacobian6(q).transpose() * w;
    for (Eigen::Index i = driven(); i < 6; ++i) tau[i] = 0.0;
    return tau;
}

Joint6 ArmKinematics::gravity_n_m(const Joint6& q) const noexcept {
    const double weight_n = p_.tip_mass_kg * kGravity;
    Joint6 tau = Joint6::Zero();
    tau[1] = (p_.gravity_thigh_n_m + weight_n * p_.thigh_m) * std::cos(q[1]);
    tau[2] = (p_.gravity_shin_n_m + weight_n * p_.shin_m) * std::sin(q[2]);
    return tau;
}

ArmConfiguration ArmKinematics::configuration(const Joint6& q) const noexcept {
    ArmConfiguration s;
    s.reach_m = p_.thigh_m * std::cos(q[1]) + p_.shin_m * std::sin(q[2]);
    s.elbow_cos = std::cos(q[2] - q[1]);
    s.wrist_cos = std::cos(q[4]);
    double most = overshoot(q[2] - q[1], p_.elbow_low_rad, p_.elbow_high_rad);
    for (Eigen::Index i = 0; i < 6; ++i) {
        if (p_.rad_per_count[i] != 0.0) most = std::max(most, overshoot(q[i], p_.low_rad[i], p_.high_rad[i]));
    }
    s.to_limit_rad = -most;
    s.near_singular = s.reach_m < kNearSingular * p_.thigh_m || s.elbow_cos < kNearSingular ||
                      (p_.wrist != Wrist::none && std::abs(s.wrist_cos) < kNearSingular);
    return s;
}

double ArmKinematics::position_step_m(const Joint6& q) const noexcept {
    const Jacobian3 j = jacobian(q);
    double most = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i)
        most = std::max(most, j.col(i).norm() * std::abs(p_.rad_per_count[i]));
    return most;
}

double ArmKinematics::turn_step_rad(const Joint6& q) const noexcept {
    const Jacobian6 j = jacobian6(q);
    double most = 0.0;
    for (Eigen::Index i = 0; i < 6; ++i) {
        most = std::max(most, j.block<3, 1>(3, i).norm() * std::abs(p_.rad_per_count[i]));
    }
    return most;
}

}  // namespace tact
