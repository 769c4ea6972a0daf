// Counts pairs of triangles at an edge that are nearly face to face: their normals differ by more than 150 degrees.
#pragma once

#include <cstddef>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

// Counts edges with exactly two triangles; a triangle without area counts as folded with each neighbour.
[[nodiscard]] std::size_t count_folds(const TriangleMesh& mesh);

}  // namespace tact
