// What a baked scene holds, in words and as JSON, read from the file itself.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

nlohmann::ordered_json scene_json(const SceneFile& file);
std::string scene_text(const SceneFile& file);

}  // namespace tact
