// A smoother copy of a map, on fewer voxels.
//
// Filter    the discrete Gaussian (Lindeberg 1990), whose variance is exact at any width, also below a voxel: the smoothing
//           replaces a variance of the points by one of the map (level_maps.hpp)
// Grid      every n-th voxel along each axis, and a border of three sigma, into which the density spreads. Unit and frame
//           are unchanged; the map continues with its background outside its box
// Thread    slow; never on the servo thread. Allocates two copies of the result
#pragma once

#include <cstdint>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

// every >= 1. Values that are not finite count as background.
[[nodiscard]] DensityGrid smoothed_map(const DensityGrid& grid, double background, double sigma_m,
                                       std::uint32_t every);

}  // namespace tact
