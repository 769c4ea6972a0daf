// The window's request for another scene, checked before any program ends for it: a scene that cannot be opened is refused with a
// message, and the current one continues.
//
// Input    another process' (ipc/scene/file/scene_switch): bounded, and the scene is checked as a whole
// Thread   the launcher's one
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "deploy/tact/files.hpp"
#include "deploy/tact/run_options.hpp"

namespace tact::launch {

// The option of files that are written at the end of a run and speak of one scene; empty: none was given.
[[nodiscard]] std::string bound_to_one_scene(const RunOptions& options);

class SceneSwitch {
public:
    explicit SceneSwitch(const RunOptions& options) : bound_by_(bound_to_one_scene(options)) {}
    [[nodiscard]] const std::filesystem::path& folder() const { return scratch_.path(); }
    // How the window was left, for the next one of this run where a person keeps no such file.
    [[nodiscard]] std::filesystem::path window_state() const { return folder() / "window.toml"; }
    // The scene that was asked for and can be opened.
    [[nodiscard]] std::optional<std::filesystem::path> poll();
    void refuse(const std::string& why);

private:
    ScratchFolder scratch_;
    std::string bound_by_;
};

}  // namespace tact::launch
