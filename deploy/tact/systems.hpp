// The systems that tact runs, one row each.
//
// A new system adds a row here and a folder of its own with its command, its demo, its part of tact info and of a run. Names,
// sections and raw files of its scenes are a row of ipc/scene/file/scene_kinds.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "deploy/tact/run_options.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_kinds.hpp"

namespace tact::launch {

struct System {
    SceneKind kind;
    // Commands of tact: dock, touch, drill; and of tact demo.
    void (*add_commands)(CLI::App& app, int& exit_code);
    void (*add_demo)(CLI::App& demo, int& exit_code);
    // Options of tact-rt that this system has, for every command that runs a scene.
    std::span<const PassedOption> controller_options;
    // tact info: the keys that only such a scene has. Throws StartupError where a section is damaged.
    nlohmann::json (*info)(const SceneFile& scene);
    std::unique_ptr<SystemRun> (*open_run)(const SceneFile& scene);
    // The lines for people at the end of a run, from the report; empty where it does not have the system's keys.
    std::string (*summary)(const nlohmann::json& report);
};

[[nodiscard]] std::span<const System> systems();
// Of a kind that read_meta() accepts.
[[nodiscard]] const System& system_of(SceneKind kind);
[[nodiscard]] const System& system_of(const SceneFile& scene);

}  // namespace tact::launch
