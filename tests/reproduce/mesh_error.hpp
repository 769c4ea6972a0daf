// Distances between a simplified mesh and its original: from all vertices of each mesh to the surface of the other.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::launch {

struct MeshError {
    double rms_m = 0.0, max_m = 0.0;  // from the original vertices to the simplified surface
    double back_max_m = 0.0;          // from the simplified vertices to the original surface
    double border_max_m = 0.0;        // from the original border vertices to the simplified border; 0: closed
    double diagonal_m = 0.0;          // diagonal of the original's bounding box, as a reference length
};

// Compares every vertex with every triangle; takes seconds for ten thousand vertices.
[[nodiscard]] MeshError mesh_error(const TriangleMesh& original, const TriangleMesh& simplified);

}  // namespace tact::launch
