// Loads a scene in the background.
//
// Thread   frame thread; loading on its own thread.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gui/render/scene_content.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

class SceneLoader {
public:
    struct Outcome {
        std::shared_ptr<const SceneContent> content;  // null: failed
        std::unique_ptr<SceneStart> start;
        std::string error;
    };
    // Returns false and starts nothing while another scene is loading.
    bool start(const std::string& path);
    [[nodiscard]] bool running() const { return loading_.valid(); }
    [[nodiscard]] std::optional<Outcome> poll();  // once, when done

private:
    struct Loaded {
        std::shared_ptr<const SceneContent> content;
        std::unique_ptr<SceneStart> start;
    };
    std::future<Loaded> loading_;
};

}  // namespace tact
