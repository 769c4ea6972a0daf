// The isosurface of a density map at a given level, as a welded triangle mesh.
//
// Inside    density above the level; triangles are counter-clockwise viewed from outside. NaN is outside
// Border    the surface stays open at the border of the map's box
// Result    manifold: every edge has two triangles, or one at the border of the box. No triangle is
//           degenerate: a vertex keeps a distance of 1/128 of a voxel edge from a voxel's centre
// Frame     model, metres
// Memory    20 bytes per voxel of two slices, in addition to the result
// Errors    StartupError when the number of values differs from the grid's size, the level is not finite,
//           or the surface would have more than 2^28 vertices
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

TriangleMesh isosurface(const DensityGrid& grid, double level, const Progress& progress = {});

}  // namespace tact
