// Reports the field of a scene for tact-prep info.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Adds the keys of the system to `json`. Throws StartupError if a section is damaged.
void report_field(const SceneFile& file, nlohmann::ordered_json& json);

}  // namespace tact
