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

// What a command that has written a scene prints: the note and one line, or with as_json one object of the
// scene's path, what the system reports of it, and the seconds it took.
void print_written_scene(const std::string& scene, const std::string& note, double seconds, bool as_json,
                         const nlohmann::ordered_json& report);

}  // namespace tact
