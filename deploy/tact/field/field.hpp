// The field's row of deploy/tact/systems: tact field, tact demo field, and tact info of such a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "deploy/tact/run_options.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

void add_field(CLI::App& app, int& exit_code);
void add_field_demo(CLI::App& demo, int& exit_code);

nlohmann::json field_info(const SceneFile& scene);
std::unique_ptr<SystemRun> open_field_run(const SceneFile& scene);
std::string field_summary(const nlohmann::json& report);  // always empty

}  // namespace tact::launch
