// What `tact info` tells of a surface to touch: the mesh, its tree and forest, their sizes, and the force in words.
#pragma once

#include <nlohmann/json.hpp>

#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

// Fails by StartupError where a section is damaged.
nlohmann::json surface_info(const SceneFile& file);

}  // namespace tact::launch
