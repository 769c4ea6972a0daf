// Docking's row of deploy/tact/systems: tact dock, tact eval, tact search, tact refine, tact demo dock, and the report of a docking run.
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

void add_docking_commands(CLI::App& app, int& exit_code);
void add_dock(CLI::App& app, int& exit_code);
void add_eval(CLI::App& app, int& exit_code);
void add_search(CLI::App& app);
void add_docking_demo(CLI::App& demo, int& exit_code);
std::span<const PassedOption> docking_controller_options();

nlohmann::json docking_info(const SceneFile& scene);
std::unique_ptr<SystemRun> open_docking_run(const SceneFile& scene);
std::string docking_summary(const nlohmann::json& report);

}  // namespace tact::launch
