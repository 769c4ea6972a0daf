// What a scene is, read from its header, its section table and section META alone: lists of files show it without reading
// gigabytes. Whoever opens the scene checks all of it (SceneFile::open).
//
// Fails by StartupError, as SceneFile::open does.
// Thread   any but the servo thread; reads some kilobytes of the file.
#pragma once

#include <filesystem>

#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

[[nodiscard]] SceneMeta peek_scene(const std::filesystem::path& path);

}  // namespace tact
