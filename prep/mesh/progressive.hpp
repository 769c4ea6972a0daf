// Bakes a triangle mesh into a progressive mesh: simplify() to the coarsest level, stored in reverse.
//
// Normals   at every level a vertex has the area-weighted mean normal of the original surface that it represents, so
//           shading stays smooth at coarse levels.
// error_m   of a level: the largest error_m of the contractions below it.
// Fails by  StartupError for a mesh without triangles.
#pragma once

#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "prep/mesh/simplify.hpp"

namespace tact {

ProgressiveMeshData make_progressive(const TriangleMesh& mesh, const SimplifySettings& settings = {},
                                     const Progress& progress = {});

// Bakes and adds section MESH.
void write_progressive_mesh(SceneWriter& out, std::uint32_t index, const TriangleMesh& mesh,
                            const SimplifySettings& settings = {}, const Progress& progress = {});

}  // namespace tact
