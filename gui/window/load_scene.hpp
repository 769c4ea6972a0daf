// Reads a baked scene.
#pragma once

#include <filesystem>
#include <memory>

#include "gui/render/scene_content.hpp"

namespace tact {

// On the loader thread: it may take a second for large meshes. Throws StartupError naming the file.
std::shared_ptr<const SceneContent> load_scene(const std::filesystem::path& path);

}  // namespace tact
