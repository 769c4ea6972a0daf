// Adds structures to a docking scene: bakes it again from the same files with the same options, and these structures.
//
// Errors   StartupError: no docking scene, files that are not recorded, missing or changed, too many structures
#pragma once

#include <filesystem>
#include <vector>

#include "deploy/tact/baked_run.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

// True for a scene or a session, by their endings: not a map.
[[nodiscard]] bool is_scene_or_session(const std::filesystem::path& file);

// The request for the scene with these structures behind its own.
[[nodiscard]] BakeRequest request_with(const SceneFile& scene,
                                       const std::vector<std::filesystem::path>& models);

// tact dock SCENE MODEL...: bakes, then runs with the bodies of the session, if it is one, where they were. Returns the exit code.
int dock_into_scene(const std::filesystem::path& scene_or_session,
                    const std::vector<std::filesystem::path>& models, const BakedRun& baked);

}  // namespace tact::launch
