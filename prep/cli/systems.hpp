// The systems that tact-prep bakes scenes for, one row each.
//
// A new system adds a row here and a folder of its own with its commands, bake function and report. The names, sections
// and raw file endings of its scenes are a row of ipc/scene/file/scene_kinds.
#pragma once

#include <CLI/CLI.hpp>
#include <span>

#include "ipc/scene/file/scene_meta.hpp"
#include "prep/console/scene_report.hpp"

namespace tact {

struct PrepSystem {
    SceneKind kind;
    // Adds tact-prep WORD FILE... and tact-prep demo WORD. The commands run as callbacks inside parse().
    void (*add_commands)(CLI::App& app, CLI::App& demo);
    SystemReport report;
    // Adds tact-prep examine WORD FILE...; null: the files say all.
    void (*add_examine)(CLI::App& examine);
};

[[nodiscard]] std::span<const PrepSystem> prep_systems();
// `kind` must be one that read_meta() accepts.
[[nodiscard]] const PrepSystem& prep_system(SceneKind kind);

}  // namespace tact
