// Steepest ascent. Rotations are scaled by the radius of gyration to a displacement of the points. The step doubles after a
// success and halves after a failure, until it is below the least.
#include "ipc/scene/density/climb.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tact {

Pose climbed(const DensityMap& map, const PointsView& points, Pose pose, int sums_max,
             const ClimbSteps* steps) noexcept {
    double gyration_2 = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 p(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                     static_cast<double>(points.z[i]));
        gyration_2 += static_cast<double>(points.weight[i]) * p.squaredNorm();
    }
    const double voxel_m = map.spacing_m().minCoeff();
    const double radius_m = std::max(std::sqrt(gyration_2), 0.1 * voxel_m);
    const ClimbSteps by = steps != nullptr ? *steps : ClimbSteps{0.2 * voxel_m, voxel_m, 1e-3 * voxel_m};
    double step_m = by.first_m;
    DensitySums here = map.sum(points, pose);
    for (int i = 1; i < sums_max && step_m > by.least_m; ++i) {
        const Vec3 turn = here.moment / radius_m;
        const double slope = std::sqrt(here.gradient.squaredNorm() + turn.squaredNorm());
        if (!(slope > 0.0)) break;
        const Pose next{
            pose.p_m + step_m / slope * here.gradient,
            (quat_from_rotation_vector(step_m / (slope * radius_m) * turn) * pose.q).normalized()};
        const DensitySums there = map.sum(points, next);
        if (there.density_sigma > here.density_sigma + 0.1 * step_m * slope) {
            pose = next, here = there;
            step_m = std::min(2.0 * step_m, by.most_m);
        } else {
            step_m *= 0.5;
        }
    }
    return pose;
}

double spectral_norm(const Eigen::Matrix3d& symmetric) noexcept {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(symmetric, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace tact
