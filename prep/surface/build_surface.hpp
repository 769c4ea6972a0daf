// Builds the surface that is touched from a triangle mesh: order, normals, tree (ipc/scene/mesh/surface_mesh.hpp).
//
// Order     triangles by their centres along a Hilbert curve, so that four consecutive ones form a patch; vertices by
//           first use, without those that no triangle uses
// Normals   area-weighted mean of the facets at a vertex
// Closed    every edge is traversed equally often in both directions: the surface has an inside. Tested by a sum of
//           random numbers; wrong with a probability of 2^-64.
// Thread    any but the servo's.  Fails by  StartupError for a mesh without triangles, with too many, or with an index
//           or number out of range; Cancelled from progress.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {

SurfaceData build_surface(const TriangleMesh& mesh, const Progress& progress = {});

}  // namespace tact
