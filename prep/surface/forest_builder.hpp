// Builds the view-dependence forest of a mesh from its contractions (prep/mesh/simplify.hpp).
//
// Renumbers the vertices of the mesh into the order of the leaves; triangles keep their order, so a tree over
// them may be built before or after. What else is kept per vertex follows `order`.
// Local     contractions also weigh how far the vertices lie apart that one comes to stand for, so that the
//           part of the mesh below a node stays round and what is asked for near the probe forces few splits
//           elsewhere. Figures with and without: README.md beside this.
// Memory    some 250 bytes a vertex while it contracts.  Thread  any but the servo's.
// Fails by  StartupError; a mesh without triangles is refused.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

struct ForestSettings {
    double locality = 0.03;  // see SimplifySettings; 0: the least error alone decides
};

struct BuiltForest {
    VertexForestData data;
    std::vector<std::uint32_t> order;  // of each leaf: the number that its vertex had
};

BuiltForest build_forest(TriangleMesh& mesh, const ForestSettings& settings = {},
                         const Progress& progress = {});

// How wide the parts below nodes are: reach over the root of the area that they stand for, about 0.7 for
// squares. Of nodes with from 16 leaves on; the mean, and the value that one in a hundred exceeds.
struct ForestShape {
    double mean = 0.0, p99 = 0.0;
    std::uint32_t trees = 0, depth = 0;  // depth: of the deepest leaf
};
ForestShape shape_of(const VertexForest& forest, std::span<const std::uint32_t> corner);

}  // namespace tact
