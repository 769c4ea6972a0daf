// What `tact info` tells of bone to drill: its volume, its structures, their sizes, and the force in words.
#pragma once

#include <nlohmann/json.hpp>

#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

// Fails by StartupError where a section is damaged.
nlohmann::json drilling_info(const SceneFile& file);

}  // namespace tact::launch
