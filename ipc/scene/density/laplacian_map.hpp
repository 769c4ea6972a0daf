// Emphasizes a map's contours instead of its mass, as an alternative to the density for the force.
//
// Filter    -sigma^2 Laplacian of (Gaussian * map), sigma = 0.225 * resolution, in the map's unit. Positive
//           where the density is a ridge or a hump, negative just outside a surface, zero where it is flat:
//           also deep inside a thick, uniform mass, which the density itself rewards most
// Grid      same voxels, same frame. Outside its box the map continues with its background; the filtered
//           value there is 0, so 0 is the background of the result
// Thread    slow (20 to 50 ms for 100^3); never on the servo thread. Allocates some copies of the map
// Errors    StartupError if the resolution is not positive and finite
#pragma once

#include "ipc/scene/density/density_map.hpp"

namespace tact {

[[nodiscard]] DensityGrid laplacian_map(const DensityGrid& grid, double background, double resolution_m);

// Root mean square of the values over the box: the unit of a map whose background is 0.
[[nodiscard]] double rms_of(const DensityGrid& grid);

}  // namespace tact
