// Continues what is shown in a scene that was baked with more structures: writes its session for the launcher, on a thread of its own,
// because both scenes are read.
//
// Files    kAddedSession and kShownSession in the launcher's folder (ipc/scene/file/scene_switch)
// Thread   frame thread
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "ipc/scene/session/session_file.hpp"

namespace tact {

class SceneExtender {
public:
    struct Outcome {
        std::filesystem::path session;  // to ask the launcher for
        std::string error;              // empty: none
    };
    // shown: the present session. Ignored while another one is being written.
    void start(Session shown, std::filesystem::path scene, std::filesystem::path folder);
    [[nodiscard]] std::optional<Outcome> poll();  // once

private:
    std::future<Outcome> writing_;
};

}  // namespace tact
