// The scene of a recording.
#pragma once

#include <filesystem>

#include "ipc/record/recording_reader.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// The file that a person names, or the one of the recorded name that has the recorded checksum: beside the recording, in
// this folder, or among the scenes that `tact` baked. Recordings of before 2026-11-23 have a path. Throws StartupError.
[[nodiscard]] SceneFile open_recorded_scene(const RecordingReader::About& about,
                                            const std::filesystem::path& recording,
                                            const std::filesystem::path& scene_path);

}  // namespace tact
