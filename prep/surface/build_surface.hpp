// A triangle mesh becomes the surface that is touched: order, normals and tree (ipc/scene/mesh/surface_mesh.hpp).
//
// Order     triangles by the place of their centres on a Hilbert curve, so that four in a row are a patch;
//           vertices by first use, and those that no triangle uses are left out
// Normals   mean of the facets at a vertex, by area
// Closed    every edge is passed as often one way as the other: the surface has an inside. By a sum of
//           random numbers; wrong once in 2^64.
// Thread    any but the servo's.  Fails by  StartupError for a mesh without triangles, with too many, or with
//           an index or number out of range; Cancelled from progress.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

SurfaceData build_surface(const TriangleMesh& mesh, const Progress& progress = {});

}  // namespace tact
