// The systems that tact runs, one row each.
//
// A new system adds a row here and a folder of its own with its command, its demo, its part of tact info and of a run.
// The names, sections and raw files of its scenes are a row of ipc/scene/file/scene_kinds.
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
    // Commands of tact (dock, touch, drill) and of tact demo.
    void (*add_commands)(CLI::App& app, int& exit_code);
    void (*add_demo)(CLI::App& demo, int& exit_code);
    // The system's options of tact-rt, for every command that runs a scene.
    std::span<const PassedOption> controller_options;
    // tact info: the keys of such a scene. Throws StartupError if a section is damaged.
    nlohmann::json (*info)(const SceneFile& scene);
    std::unique_ptr<SystemRun> (*open_run)(const SceneFile& scene);
    // The text lines at the end of a run, from the report; empty if the report lacks the system's keys.
    std::string (*summary)(const nlohmann::json& report);
};

[[nodiscard]] std::span<const System> systems();
// `kind` must be one that read_meta() accepts.
[[nodiscard]] const System& system_of(SceneKind kind);
[[nodiscard]] const System& system_of(const SceneFile& scene);

}  // namespace tact::launch
