// Reads a baked scene.
#pragma once

#include <filesystem>
#include <memory>

#include "gui/render/scene_content.hpp"

namespace tact {

// For the loader thread: a large mesh may take a second. Throws StartupError naming the file.
std::shared_ptr<const SceneContent> load_scene(const std::filesystem::path& path);

}  // namespace tact
