// Finds the scene of a recording.
#pragma once

#include <filesystem>

#include "ipc/record/recording_reader.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Opens scene_path if given, else the file with the recorded name and checksum: beside the recording, in the current
// folder, or among the scenes baked by `tact`. Recordings made before 2026-11-23 hold a full path. Throws StartupError.
[[nodiscard]] SceneFile open_recorded_scene(const RecordingReader::About& about,
                                            const std::filesystem::path& recording,
                                            const std::filesystem::path& scene_path);

}  // namespace tact
