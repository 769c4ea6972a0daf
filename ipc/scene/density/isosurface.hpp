// The surface where a density map has a given level, as a welded triangle mesh.
//
// Inside    density above the level; triangles are counter-clockwise seen from outside. NaN is outside.
// Border    the surface ends where the box of the map ends: it stays open there.
// Result    manifold: every edge has two triangles, or one at the border of the box. No triangle is
//           degenerate: a vertex keeps 1/128 of a voxel edge away from the voxel's centre.
// Frame     model, metres.  Memory  20 bytes per voxel of two slices besides the result.
// Fails by  StartupError when the grid is not as long as its sizes say, the level is not finite, or the
//           surface would have more than 2^28 vertices.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

TriangleMesh isosurface(const DensityGrid& grid, double level, const Progress& progress = {});

}  // namespace tact
