// The window's request for another scene, or for a file of drilled bone (*.bone). It is checked before any program ends: a scene that cannot be opened is
// refused with a message, and the current one continues.
//
// Input    from another process (ipc/scene/file/scene_switch): bounded; the scene is checked completely
// Thread   the launcher's only thread
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "deploy/tact/files.hpp"
#include "deploy/tact/run_options.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::launch {

// The option that binds a run to its scene, because it writes files about it; empty: none was given. A recording is of one controller; all
// else is written at the end, about the scene as it is then, and so may have got more structures, or lost them again (extends).
[[nodiscard]] std::string bound_to_one_scene(const RunOptions& options, bool extends);

// What a run shows: a scene, perhaps with bone that was kept of it, or with all that a session holds.
struct Asked {
    std::filesystem::path scene;
    std::filesystem::path bone{};     // empty: as baked
    std::filesystem::path session{};  // empty: none
    bool bodies = false;              // the session has bodies
    bool extends = false;  // it is the scene that is shown, with more structures or without those added
    std::filesystem::path back{};  // the session to go back to if it does not start; empty: as this run began
};
// file: a scene or a session. Throws StartupError: not readable, or the scene of the session is not found.
[[nodiscard]] Asked asked_of(const std::filesystem::path& file);

class SceneSwitch {
public:
    explicit SceneSwitch(const RunOptions& options)
        : bound_by_(bound_to_one_scene(options, false)),
          bound_extending_by_(bound_to_one_scene(options, true)) {}
    [[nodiscard]] const std::filesystem::path& folder() const { return scratch_.path(); }
    // Window state for the next window of this run, if the user keeps no such file.
    [[nodiscard]] std::filesystem::path window_state() const { return folder() / "window.toml"; }
    [[nodiscard]] std::optional<Asked> poll(const SceneFile& shown);
    void refuse(const std::string& why);

private:
    ScratchFolder scratch_;
    std::string bound_by_, bound_extending_by_;
};

}  // namespace tact::launch
