// Builds the view-dependence forest of a mesh from its contractions (prep/mesh/simplify.hpp).
//
// Renumbers the vertices of the mesh in the order of the leaves; triangles keep their order, so a tree over them can be
// built before or after. Other data per vertex must be permuted by `order`.
// Local     contractions also weigh the extent of the surface that a vertex represents, so that the part of the mesh
//           below a node stays compact and refinement near the probe forces few splits elsewhere. Measurements with
//           and without: prep/DECISIONS.md.
// Memory    about 250 bytes per vertex during contraction.  Thread  any but the servo's.
// Fails by  StartupError for a mesh without triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

struct ForestSettings {
    double locality = 0.03;  // see SimplifySettings; 0: only the error counts
};

struct BuiltForest {
    VertexForestData data;
    std::vector<std::uint32_t> order;  // per leaf: the original number of its vertex
};

BuiltForest build_forest(TriangleMesh& mesh, const ForestSettings& settings = {},
                         const Progress& progress = {});

// Width of the parts below nodes: reach over the square root of the area (about 0.7 for squares), for nodes with at
// least 16 leaves; mean and 99th percentile.
struct ForestShape {
    double mean = 0.0, p99 = 0.0;
    std::uint32_t trees = 0, depth = 0;  // depth of the deepest leaf
};
ForestShape shape_of(const VertexForest& forest, std::span<const std::uint32_t> corner);

}  // namespace tact
