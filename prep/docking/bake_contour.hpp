// Bakes the surface of a scene's map at another level to a file of its own (ipc/scene/density/contour_mesh.hpp).
//
// Fails by  StartupError: the scene has no map, or no surface lies at the level. Cancelled from progress.
#pragma once

#include "ipc/base/progress.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct BakedContour {
    std::size_t vertices_found = 0;
    std::uint32_t vertices = 0, vertices_min = 0, triangles = 0;
};

// vertices_max 0: no limit.
BakedContour bake_contour(const SceneFile& scene, double level, std::uint32_t vertices_max, SceneWriter& out,
                          const Progress& progress = {});

}  // namespace tact
