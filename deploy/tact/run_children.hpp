// Command lines of the programs of a run, and the fix for a failed program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "deploy/tact/run_options.hpp"
#include "deploy/tact/scene_switch.hpp"

namespace tact::launch {

// Arguments of tact-rt. first: the first scene of a run, which is armed as soon as the run is up.
std::vector<std::string> controller_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                              bool first);
// Arguments of tact-gui. scene_switch: null if the window cannot request another scene; own: options of the system.
std::vector<std::string> window_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                          const SceneSwitch* scene_switch, bool first,
                                          const std::vector<std::string>& own);

// The fix for a program that failed.
std::string advice(const std::string& name, const Ending& ending);

}  // namespace tact::launch
