// With x = 1 + y eq. 2 is y^3 - 3 y - 2 + 3 mu = 0, mu = m0 / (pi R^3), and y = 2 cos(theta) gives cos(3 theta) =
// 1 - 3 mu / 2. The root between 0 and 2, written with sin(psi)^2 = 3 mu / 4 so that nothing cancels at either end:
//     x = 2 sin^2(psi / 3) + sqrt(3) sin(2 psi / 3).
// A cap of height h holds m1 = pi R^4 x^2 (2 - x)^2 / 4, and nothing of the same mass holds more.
#include "rt/force/drilling/burr_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {

double penetration_of(double m0_m3, double radius_m) noexcept {
    const double mu = m0_m3 / (std::numbers::pi * radius_m * radius_m * radius_m);
    if (!(mu > 0.0)) return 0.0;
    const double psi = std::asin(std::sqrt(std::min(0.75 * mu, 1.0)));
    const double s = std::sin(psi / 3.0);
    return std::min(2.0 * s * s + std::numbers::sqrt3 * std::sin(2.0 * psi / 3.0), 2.0);
}

double elastic_for(double radius_m, double depth_at_1_n_m) noexcept {
    const double x = std::min(depth_at_1_n_m / radius_m, 0.5);
    return 1.0 / (radius_m * radius_m * x * std::sqrt(x));
}

BurrForce burr_force(const BurrLaw& law, double radius_m, double m0_m3, const Vec3& m1_m4,
                     const Vec3& velocity_m_s, const Vec3& spin_rad_s, const Vec3& way_out) noexcept {
    constexpr double kCapShare = 0.25;  // of a cap's moment, from which on the normal is whole
    constexpr double kCapLeast = 0.03;  // of it where the ball is nearly full and a cap has none either
    BurrForce f;
    const double x = penetration_of(m0_m3, radius_m);
    if (!(x > 0.0)) return f;
    f.depth = x;
    const double r2 = radius_m * radius_m;
    const double whole =
        std::numbers::pi * r2 * r2 * x * x * (kCapShare * 0.25 * (2.0 - x) * (2.0 - x) + kCapLeast);
    const double moment = m1_m4.norm();
    if (moment > 0.0) {
        const double part = std::min(moment / whole, 1.0);
        f.normal = -(part * (1.5 - 0.5 * part * part) / moment) * m1_m4;
    }
    if (x > kWayOutFrom) {
        const double s = std::min((x - kWayOutFrom) / (kWayOutTo - kWayOutFrom), 1.0);
        f.normal += s * s * (3.0 - 2.0 * s) * std::max(1.0 - f.normal.norm(), 0.0) * way_out;
    }
    if (moment > 0.0) f.held_in = (f.normal + m1_m4 / moment).squaredNorm() > kHeldInShare * kHeldInShare;
    const double elastic = law.elastic_pa * r2 * x * std::sqrt(x);
    f.stiffness_n_m = 1.5 * law.elastic_pa * radius_m * std::sqrt(x);
    const Vec3 lever = m1_m4 / std::max(m0_m3, 1e-30);  // to the middle of what is touched
    Vec3 rub = law.friction_n_s_m3 * r2 * x * lever.cross(spin_rad_s);
    // Friction across the push feeds a burr that whirls; no more than this of the push is damped by a hand.
    if (law.friction_share > 0.0) rub /= 1.0 + rub.norm() / (law.friction_share * elastic);
    f.wrench.force_n = elastic * f.normal + rub - law.impact_n_s_m3 * r2 * x * velocity_m_s;
    f.wrench.torque_n_m = lever.cross(rub);
    return f;
}

}  // namespace tact
