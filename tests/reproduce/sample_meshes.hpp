// Synthetic meshes for figures 3 and 4 of the docking paper.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::launch {

// A bent sheet with an open border: 50 by 25 vertices, 1 m by 0.6 m.
[[nodiscard]] TriangleMesh open_sheet();

// Closed isosurface of a chaperonin-like density: two rings of eight subunits back to back, each subunit with a peak at
// the end of the cylinder. Uses the coarsest grid with at least `vertices_min` vertices.
[[nodiscard]] TriangleMesh chaperonin(std::size_t vertices_min);

}  // namespace tact::launch
