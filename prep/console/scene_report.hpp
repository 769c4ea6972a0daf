// Contents of a baked scene as text and as JSON, read from the file itself.
//
// add_system adds the keys that only one kind of scene has (prep/cli/systems).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

using SystemReport = void (*)(const SceneFile& file, nlohmann::ordered_json& report);

nlohmann::ordered_json scene_json(const SceneFile& file, SystemReport add_system);
std::string scene_text(const SceneFile& file, SystemReport add_system);

// Prints the result of a command that wrote a scene: the note and one line, or with as_json one object of the
// scene's path, the report of its system and the time in seconds.
void print_written_scene(const std::string& scene, const std::string& note, double seconds, bool as_json,
                         const nlohmann::ordered_json& report);

}  // namespace tact
