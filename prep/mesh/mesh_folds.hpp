// Pairs of triangles at an edge that lie nearly face to face: their normals are more than 154 degrees apart.
#pragma once

#include <cstddef>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

// Edges with two triangles alone; triangles without area count as folded on each of their neighbours.
[[nodiscard]] std::size_t count_folds(const TriangleMesh& mesh);

}  // namespace tact
