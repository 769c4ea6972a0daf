// Climbs from a pose to a nearby maximum of the summed density: where a body ends that follows its force.
//
// Thread   any; no allocation. Costs up to sums_max sums over the points
#pragma once

#include "ipc/scene/density/density_map.hpp"

namespace tact {

// Lengths of a step, as displacements of the points.
struct ClimbSteps {
    double first_m, most_m, least_m;
};
// steps: null: by the map's smallest voxel, a fifth, one and a thousandth.
[[nodiscard]] Pose climbed(const DensityMap& map, const PointsView& points, Pose start, int sums_max,
                           const ClimbSteps* steps = nullptr) noexcept;

// Spectral norm of a symmetric matrix: its largest eigenvalue by magnitude.
[[nodiscard]] double spectral_norm(const Eigen::Matrix3d& symmetric) noexcept;

}  // namespace tact
