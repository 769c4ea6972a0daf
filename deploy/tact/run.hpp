// A run: starts, monitors and ends controller and visual process together, and writes the results.
#pragma once

#include <filesystem>

#include "deploy/tact/run_options.hpp"

namespace tact::launch {

// Returns the exit code: 0 if all ended as requested, 1 if a process died or had to be killed.
int run_scene(const std::filesystem::path& scene, RunOptions options);

}  // namespace tact::launch
