// The programs of a run: their command lines, and the fix for one that failed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "deploy/tact/run_options.hpp"
#include "deploy/tact/scene_switch.hpp"

namespace tact::launch {

// Of tact-rt. first: the first scene of a run, which is armed as soon as the run is up.
std::vector<std::string> controller_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                              bool first);
// Of tact-gui. scene_switch: null where the window cannot request another scene; own: the options of the system.
std::vector<std::string> window_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                          const SceneSwitch* scene_switch, bool first,
                                          const std::vector<std::string>& own);

// The fix for a program that failed.
std::string advice(const std::string& name, const Ending& ending);

}  // namespace tact::launch
