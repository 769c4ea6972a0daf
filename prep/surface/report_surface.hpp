// Reports the mesh of a scene with a surface to touch for tact-prep info.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Adds the keys of the system to `json`. Throws StartupError if a section is damaged.
void report_surface(const SceneFile& file, nlohmann::ordered_json& json);

}  // namespace tact
