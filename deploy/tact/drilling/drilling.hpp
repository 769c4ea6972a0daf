// Drilling's row of deploy/tact/systems: tact drill, tact demo drill, and the report of a drilling run.
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

void add_drill(CLI::App& app, int& exit_code);
void add_drill_demo(CLI::App& demo, int& exit_code);
std::span<const PassedOption> drilling_controller_options();
// Without a device and an explicit choice: an emulated surgeon with a burr, and a second hand with a suction tube.
void let_the_hands_drill(RunOptions& options);
extern const char* const kDemoTask;  // deploy/training/mastoid.toml
// Where the emulated surgeon opens the synthetic temporal bone: behind the ear canal, over the antrum (--hand-at-mm).
inline constexpr const char* kMastoidMm = "-4.5,0";

nlohmann::json drilling_info(const SceneFile& scene);
std::unique_ptr<SystemRun> open_drilling_run(const SceneFile& scene);
std::string drilling_report_summary(const nlohmann::json& report);

}  // namespace tact::launch
