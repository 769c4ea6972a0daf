#include "tests/reference/drilling_reference.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tact::reference {

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

double Volume::bone(std::int64_t x, std::int64_t y, std::int64_t z) const {
    if (x < 0 || y < 0 || z < 0 || x >= size[0] || y >= size[1] || z >= size[2]) return 0.0;
    return level(x, y, z) / 255.0;
}

Moments moments_in_ball(const Volume& volume, const Eigen::Vector3d& centre_m, double radius_m, int parts) {
    const Eigen::Vector3d centre = (centre_m - volume.origin_m) / volume.voxel_m;
    const double radius = radius_m / volume.voxel_m, half_diagonal = 0.5 * std::sqrt(3.0);
    double m0 = 0.0;
    Eigen::Vector3d m1 = Eigen::Vector3d::Zero();
    const auto from = [&](int axis) {
        return static_cast<std::int64_t>(std::floor(centre[axis] - radius - 0.5));
    };
    const auto to = [&](int axis) {
        return static_cast<std::int64_t>(std::ceil(centre[axis] + radius + 0.5));
    };
    for (std::int64_t z = from(2); z <= to(2); ++z)
        for (std::int64_t y = from(1); y <= to(1); ++y)
            for (std::int64_t x = from(0); x <= to(0); ++x) {
                const Eigen::Vector3d r =
                    Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) -
                    centre;
                const double distance = r.norm();
                if (distance > radius + half_diagonal) continue;
                const double rho = volume.bone(x, y, z);
                if (rho == 0.0) continue;
                if (distance < radius - half_diagonal) {
                    m0 += rho;
                    m1 += rho * r;
                    continue;
                }
                double share = 0.0;
                Eigen::Vector3d first = Eigen::Vector3d::Zero();
                for (int k = 0; k < parts; ++k)
                    for (int j = 0; j < parts; ++j)
                        for (int i = 0; i < parts; ++i) {
                            const Eigen::Vector3d p =
                                r + Eigen::Vector3d((i + 0.5) / parts - 0.5, (j + 0.5) / parts - 0.5,
                                                    (k + 0.5) / parts - 0.5);
                            if (p.squaredNorm() > radius * radius) continue;
                            share += 1.0;
                            first += p;
                        }
                const double each = rho / (static_cast<double>(parts) * parts * parts);
                m0 += each * share;
                m1 += each * first;
            }
    const double v = volume.voxel_m * volume.voxel_m * volume.voxel_m;
    return {v * m0, v * volume.voxel_m * m1};
}

double penetration(double m0_m3, double radius_m) {
    const double filled = m0_m3 / (kPi * radius_m * radius_m * radius_m);
    double low = 0.0, high = 2.0;
    for (int i = 0; i < 100; ++i) {
        const double x = 0.5 * (low + high);
        (x * x * (1.0 - x / 3.0) < filled ? low : high) = x;
    }
    return low;
}

double cap_moment_m4(double depth, double radius_m) {
    return kPi / 4.0 * std::pow(radius_m, 4.0) * depth * depth * (2.0 - depth) * (2.0 - depth);
}

BurrWrench burr_wrench(const Law& law, double radius_m, const Moments& moments,
                       const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& spin_rad_s) {
    BurrWrench out;
    if (!(moments.m0_m3 > 0.0)) return out;
    out.depth = penetration(moments.m0_m3, radius_m);
    const double r2 = radius_m * radius_m;
    out.elastic_n = law.elastic_pa * r2 * std::pow(out.depth, 1.5);
    const double moment = moments.m1_m4.norm();
    Eigen::Vector3d push = Eigen::Vector3d::Zero();
    if (moment > 0.0) push = -out.elastic_n / moment * moments.m1_m4;
    const Eigen::Vector3d lever = moments.m1_m4 / moments.m0_m3;
    Eigen::Vector3d rub = law.friction_n_s_m3 * r2 * out.depth * lever.cross(spin_rad_s);
    if (law.friction_share > 0.0 && out.elastic_n > 0.0)
        rub = rub / (1.0 + rub.norm() / (law.friction_share * out.elastic_n));
    out.force_n = push + rub - law.impact_n_s_m3 * r2 * out.depth * velocity_m_s;
    out.torque_n_m = lever.cross(rub);
    return out;
}

}  // namespace tact::reference
