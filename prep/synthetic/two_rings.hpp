// A synthetic map of two rings of seven subunits of three blobs each: the test shape for simplification.
#pragma once

#include "ipc/scene/density/density_map.hpp"

namespace tact {

inline constexpr double kTwoRingsContour = 0.35;

// 73³ voxels over [-1, 1]³ metres; the isosurface at kTwoRingsContour is closed and has 12,424 vertices.
DensityGrid two_rings_map();

}  // namespace tact
