// Describes a scene from its header, its section table and section META alone, so that file lists need not
// read gigabytes. SceneFile::open checks the whole file later.
//
// Errors   StartupError, like SceneFile::open
// Thread   any but the servo thread; reads some kilobytes of the file
#pragma once

#include <filesystem>

#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

// True if the file begins as a scene does; false also if it cannot be read.
[[nodiscard]] bool is_scene(const std::filesystem::path& path) noexcept;
[[nodiscard]] SceneMeta peek_scene(const std::filesystem::path& path);

}  // namespace tact
