// The surface's row of deploy/tact/systems: tact touch, tact demo touch, and tact info of such a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "deploy/tact/run_options.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

void add_touch(CLI::App& app, int& exit_code);
void add_touch_demo(CLI::App& demo, int& exit_code);
std::span<const PassedOption> surface_controller_options();
// Without a device and an explicit choice, the emulated hand strokes the surface, because a surface moves no hand.
void let_the_hand_stroke(RunOptions& options);

nlohmann::json surface_info(const SceneFile& scene);
std::unique_ptr<SystemRun> open_surface_run(const SceneFile& scene);
std::string surface_summary(const nlohmann::json& report);  // always empty

}  // namespace tact::launch
