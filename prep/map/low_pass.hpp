// Smooths a map to a coarser resolution for the force map. A fine map has many small local maxima that trap a
// structure far from its position.
//
// Filter   Gaussian, sigma = 0.225 * resolution, truncated at four sigma. The map continues with its background value
//          outside its box. Grid, unit and frame are unchanged.
// Thread   slow (1 s for 512^3), never the servo thread. Allocates one copy of the map.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

DensityGrid low_pass(const DensityGrid& grid, double background, double resolution_m,
                     const Progress& progress = {});

}  // namespace tact
