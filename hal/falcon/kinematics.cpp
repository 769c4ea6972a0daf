// A leg in its own axes: u from the middle of the base to its hip, v across, w to the user. The hip is the
// origin; the fixed lengths at both ends shift the middle of the grip to
//     u = p . radial - r + c,   v = p . across - s + f,   w = p . z + middle_z.
// The thigh rotates in the plane of u and w and has its knee at a (cos t, sin t). From there, the short links and
// the parallelogram lead to the grip: the short links stay in that plane, with the total length h = d + e; the
// parallelogram tilts across by v. With
//     rho = |(u - a cos t, w - a sin t)|,
//     G(p, t) = (rho - h)^2 + v^2 - b^2 = 0
// is the closure condition of a leg: a torus about the knee.
//
// Inverse   L = h + sqrt(b^2 - v^2) is rho; the law of cosines gives cos(t - atan2(w, u)), and the knee
//           that points outwards has the smaller t.
// Forward   Newton's method on the three G from a nearby position, with steps limited to kStepM. Between
//           any two places of the workspace it takes at most eight steps, from 2 mm away at most four
//           (200000 random pairs); angles that are not solved then, or only out of reach, are no
//           configuration of a Falcon.
// Jacobian  G_p dp + G_t dt = 0, so dp/dt = -M^-1 D with the rows of M the gradients G_p and D = diag(G_t).
// Virtual   work: torque = J^T F.
#include "hal/falcon/kinematics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tact::falcon {

namespace {

constexpr int kSteps = 16;
constexpr double kStepM = 0.03;
constexpr double kSolvedM = 1e-12;

Eigen::Index at(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

}  // namespace

Kinematics::Kinematics(const Geometry& geometry)
    : g_(geometry),
      rad_per_count_(2.0 * std::numbers::pi / (geometry.counts_per_turn * geometry.gear)),
      torque_per_step_(geometry.motor_n_m_per_step * geometry.gear) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double c = std::cos(g_.leg_rad[i]), s = std::sin(g_.leg_rad[i]);
        radial_[i] = Vec3(c, s, 0.0);
        across_[i] = Vec3(-s, c, 0.0);
    }
}

Vec3 Kinematics::angles_rad(const Counts3& counts) const noexcept {
    return Vec3(counts[0], counts[1], counts[2]) * rad_per_count_ + Vec3::Constant(g_.zero_rad);
}

Counts3 Kinematics::counts(const Vec3& leg_rad) const noexcept {
    Counts3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double n = std::round((leg_rad[at(i)] - g_.zero_rad) / rad_per_count_);
        out[i] = static_cast<std::int16_t>(std::clamp(n, -32768.0, 32767.0));
    }
    return out;
}

Vec3 Kinematics::in_leg(std::size_t leg, const Vec3& grip_m) const noexcept {
    return {grip_m.dot(radial_[leg]) - g_.base_m + g_.grip_m,
            grip_m.dot(across_[leg]) - g_.base_across_m + g_.grip_across_m, grip_m.z() + g_.middle_z_m};
}

bool Kinematics::inverse(const Vec3& grip_m, Vec3& leg_rad) const noexcept {
    Vec3 out;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 p = in_leg(i, grip_m);
        const double lean = g_.shin_m * g_.shin_m - p.y() * p.y();
        const double far = std::hypot(p.x(), p.z());
        if (!(lean > 0.0) || !(far > 0.0)) return false;
        const double shin = g_.ends_m + std::sqrt(lean);
        const double c = (far * far + g_.thigh_m * g_.thigh_m - shin * shin) / (2.0 * g_.thigh_m * far);
        if (!(std::abs(c) < 1.0)) return false;
        out[at(i)] = std::atan2(p.z(), p.x()) - std::acos(c);
    }
    leg_rad = out;
    return true;
}

Kinematics::Leg Kinematics::leg(std::size_t i, const Vec3& grip_m, double angle_rad) const noexcept {
    const Vec3 p = in_leg(i, grip_m);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double u = p.x() - g_.thigh_m * c, w = p.z() - g_.thigh_m * s;
    const double rho = std::hypot(u, w), bare = rho - g_.ends_m;
    const double pull = rho > 0.0 ? 2.0 * bare / rho : 0.0;
    Leg out;
    out.gradient = radial_[i] * (pull * u) + across_[i] * (2.0 * p.y()) + Vec3(0.0, 0.0, pull * w);
    out.turn = pull * g_.thigh_m * (u * s - w * c);
    out.gap = bare * bare + p.y() * p.y() - g_.shin_m * g_.shin_m;
    return out;
}

bool Kinematics::forward(const Vec3& leg_rad, const Vec3& near_m, Vec3& grip_m) const noexcept {
    if (!leg_rad.allFinite() || !near_m.allFinite()) return false;
    Vec3 p = near_m;
    for (int step = 0; step < kSteps; ++step) {
        Eigen::Matrix3d m;
        Vec3 gap;
        for (std::size_t i = 0; i < 3; ++i) {
            const Leg l = leg(i, p, leg_rad[at(i)]);
            m.row(at(i)) = l.gradient.transpose();
            gap[at(i)] = l.gap;
        }
        Eigen::Matrix3d back;
        bool solved = false;
        m.computeInverseWithCheck(back, solved);
        if (!solved) return false;
        Vec3 way = back * gap;
        const double far = way.norm();
        if (!std::isfinite(far)) return false;
        if (far > kStepM) way *= kStepM / far;
        p -= way;
        if (far > kSolvedM) continue;
        // The three tori also intersect elsewhere: behind the base, and with knees turned in.
        Vec3 again;
        if (p.norm() > kReachM || !inverse(p, again) || (again - leg_rad).cwiseAbs().maxCoeff() > 1e-9)
            return false;
        grip_m = p;
        return true;
    }
    return false;
}

ArmConfiguration Kinematics::configuration(const Vec3& grip_m) const noexcept {
    ArmConfiguration out;
    if (!grip_m.allFinite() || !inverse(grip_m, out.leg_rad)) return out;
    Eigen::Matrix3d m, directions;
    Vec3 turn;
    out.leverage = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Leg l = leg(i, grip_m, out.leg_rad[at(i)]);
        const double size = l.gradient.norm();
        m.row(at(i)) = l.gradient.transpose();
        directions.row(at(i)) = l.gradient.transpose() / size;
        turn[at(i)] = l.turn;
        out.leverage = std::min(out.leverage, std::abs(l.turn) / (size * g_.thigh_m));
    }
    out.spread = std::abs(directions.determinant());
    out.good = out.spread >= ArmConfiguration::kPoorest && out.leverage >= ArmConfiguration::kPoorest;
    if (out.good) out.jacobian = -m.inverse() * turn.asDiagonal();
    return out;
}

// The motors turn against the encoders: both sources above have the sign.
Drive Kinematics::drive(const ArmConfiguration& configuration, const Vec3& force_n) const noexcept {
    Drive out;
    if (!configuration.good || !force_n.allFinite()) return out;
    const double size = force_n.norm();
    out.share = size > kForceMaxN ? kForceMaxN / size : 1.0;
    Vec3 steps = configuration.jacobian.transpose() * (force_n * (-out.share / torque_per_step_));
    const double most = steps.cwiseAbs().maxCoeff();
    if (!std::isfinite(most)) return {};
    if (most > kTorqueMax) {
        steps *= kTorqueMax / most;
        out.share *= kTorqueMax / most;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        out.torque[i] =
            static_cast<std::int16_t>(std::clamp<double>(std::round(steps[at(i)]), -kTorqueMax, kTorqueMax));
    }
    out.valid = true;
    return out;
}

Vec3 Kinematics::force_n(const ArmConfiguration& configuration, const Torque3& torque) const noexcept {
    if (!configuration.good) return Vec3::Zero();
    const Vec3 thigh_n_m = Vec3(torque[0], torque[1], torque[2]) * -torque_per_step_;
    return configuration.jacobian.transpose().inverse() * thigh_n_m;
}

double Kinematics::position_step_m() const noexcept {
    return configuration(Vec3::Zero()).jacobian.colwise().norm().maxCoeff() * rad_per_count_;
}

}  // namespace tact::falcon
