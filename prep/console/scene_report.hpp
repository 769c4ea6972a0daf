// Contents of a baked scene, as text and as JSON, read from the file itself.
//
// add_system adds the keys that only scenes of one kind have (prep/cli/systems).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

using SystemReport = void (*)(const SceneFile& file, nlohmann::ordered_json& report);

nlohmann::ordered_json scene_json(const SceneFile& file, SystemReport add_system);
std::string scene_text(const SceneFile& file, SystemReport add_system);

}  // namespace tact
