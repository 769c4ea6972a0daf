// Bakes a triangle mesh into a progressive mesh: simplify() as far as it goes, in reverse.
//
// Normals   a vertex of any level shows the mean normal, by area, of the original surface that it stands
//           for, so shading stays smooth at coarse levels.
// error_m   of a level: the largest error_m of the contractions below it.
// Fails by  StartupError; a mesh without triangles is refused.
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
