// Slow reference of the drilling force in double precision; shares no code with rt/force.
//
// Source   eqs 1, 2, 3, 12, 13 and 14 of Agus et al. (2003)
// Volume   levels of 0 (none) to 255 (solid bone) per voxel, constant inside a voxel; outside of the volume: none
// Moments  each voxel that the ball's surface crosses is counted by parts^3 points
// Unit     SI; the frame of the volume
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>

namespace tact::reference {

struct Volume {
    std::array<std::int64_t, 3> size{};
    double voxel_m = 0.0;
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();                           // centre of voxel (0, 0, 0)
    std::function<double(std::int64_t x, std::int64_t y, std::int64_t z)> level;  // inside of the volume

    [[nodiscard]] double bone(std::int64_t x, std::int64_t y, std::int64_t z) const;  // 0 to 1; none outside
};

struct Moments {
    double m0_m3 = 0.0;                               // bone in the ball
    Eigen::Vector3d m1_m4 = Eigen::Vector3d::Zero();  // its first moment about the ball's centre
};
[[nodiscard]] Moments moments_in_ball(const Volume& volume, const Eigen::Vector3d& centre_m, double radius_m,
                                      int parts = 6);

// h / R of eq. 2, by bisection.
[[nodiscard]] double penetration(double m0_m3, double radius_m);
// First moment of a cap of this depth h / R.
[[nodiscard]] double cap_moment_m4(double depth, double radius_m);

struct Law {
    double elastic_pa = 0.0, friction_n_s_m3 = 0.0, impact_n_s_m3 = 0.0;
    double friction_share =
        0.0;  // of the elastic force, that friction does not reach; 0: eq. 13 as it stands
};
struct BurrWrench {
    double depth = 0.0;
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero(), torque_n_m = Eigen::Vector3d::Zero();  // at the centre
    double elastic_n = 0.0;
};
[[nodiscard]] BurrWrench burr_wrench(const Law& law, double radius_m, const Moments& moments,
                                     const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& spin_rad_s);

}  // namespace tact::reference
