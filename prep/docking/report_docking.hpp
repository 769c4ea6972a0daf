// The density map of a docking scene in the report of tact-prep info.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Adds its keys. Fails by StartupError where a section is damaged.
void report_docking(const SceneFile& file, nlohmann::ordered_json& json);

}  // namespace tact
