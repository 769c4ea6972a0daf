// The systems of this window, one row per kind of scene. Nothing else in gui names them.
//
// Thread   constant; read() and start() on the loader thread
#pragma once

#include <memory>
#include <span>

#include "gui/system/keys.hpp"
#include "gui/system/scene_system.hpp"
#include "gui/window/options.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

struct SystemRow {
    SceneKind kind;
    KeyWhen keys;  // that apply to its scenes
    std::unique_ptr<SceneSystem> (*make)(const GuiOptions& options);
    // Reads the system's own part of a file; the common parts are in `content`. Throws StartupError naming the file.
    std::unique_ptr<SystemContent> (*read)(SceneFile file, SceneContent& content);
    std::unique_ptr<SceneStart> (*start)(const SceneContent& content);     // null: nothing slow to prepare
    RefineContour (*refine)(std::shared_ptr<const SceneContent> content);  // null: a scene has one contour
};

// The first one is used while there is no scene.
[[nodiscard]] std::span<const SystemRow> system_rows();
// For a kind that read_meta() accepts.
[[nodiscard]] const SystemRow& system_row(SceneKind kind);

}  // namespace tact
