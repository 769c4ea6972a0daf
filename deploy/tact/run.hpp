// A run: controller and visual process started, watched and ended together, and what was measured written
// down.
#pragma once

#include <filesystem>

#include "deploy/tact/run_options.hpp"

namespace tact::launch {

// Returns the exit code: 0 where all ended as asked, 1 where something died or had to be killed.
int run_scene(const std::filesystem::path& scene, RunOptions options);

}  // namespace tact::launch
