// Distances between a simplified mesh and its original: of all vertices of each to the surface of the other.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::launch {

struct MeshError {
    double rms_m = 0.0, max_m = 0.0;  // of the original's vertices to the simplified surface
    double back_max_m = 0.0;          // of the simplified vertices to the original surface
    double border_max_m = 0.0;        // of the original's border vertices to the simplified border; 0: closed
    double diagonal_m = 0.0;          // of the original's box, as the unit of the others
};

// Tests every pair of vertex and triangle: seconds for ten thousand vertices.
[[nodiscard]] MeshError mesh_error(const TriangleMesh& original, const TriangleMesh& simplified);

}  // namespace tact::launch
