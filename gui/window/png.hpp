// Writing a picture: to a temporary file beside the target, synced and renamed, so that it is whole or
// absent.
#pragma once

#include <filesystem>

#include "gui/render/target.hpp"

namespace tact {

void write_png(const std::filesystem::path& path, const Image& image);  // throws StartupError

}  // namespace tact
