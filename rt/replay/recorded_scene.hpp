// Finds the scene of a recording.
#pragma once

#include <filesystem>

#include "ipc/record/recording_reader.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Opens scene_path if given, else the file with the recorded name and checksum: beside the recording, in the current
// folder, among the scenes baked by `tact`, or in the window's list of recent scenes, there also under another name.
// Recordings made before 2026-11-23 hold a full path. Throws StartupError, which lists all places.
[[nodiscard]] SceneFile open_recorded_scene(const RecordingReader::About& about,
                                            const std::filesystem::path& recording,
                                            const std::filesystem::path& scene_path);

// The file of drilled bone with which the recorded run started. given: its present path; empty: a file of its name beside
// the recording, in this folder, or among the kept ones. Fails if none is as it was.
[[nodiscard]] std::filesystem::path find_recorded_bone(const std::string& name, const std::string& identity,
                                                       const std::filesystem::path& recording,
                                                       const std::filesystem::path& given);

}  // namespace tact
