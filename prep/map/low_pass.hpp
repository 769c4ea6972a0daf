// A map smoothed to a coarser resolution, for the hand: fine maps are full of small hollows in which a
// structure that is still far from its place gets caught.
//
// Filter   Gaussian, sigma = 0.225 * resolution, cut at four sigma; as everywhere in Tact, the map goes on
//          with its background outside its box. Grid, unit and frame stay.
// Thread   slow (a second for 512^3); never on the servo thread. Allocates one copy of the map.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"

namespace tact {

DensityGrid low_pass(const DensityGrid& grid, double background, double resolution_m,
                     const Progress& progress = {});

}  // namespace tact
