// Reads a scene beside the frame loop.
//
// Thread   frame thread; the reading on one of its own.
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
        std::shared_ptr<const SceneContent> content;  // null: it failed
        std::unique_ptr<SceneStart> start;
        std::string error;
    };
    // False, and nothing is begun, while another is being read.
    bool start(const std::string& path);
    [[nodiscard]] bool running() const { return loading_.valid(); }
    [[nodiscard]] std::optional<Outcome> poll();  // once, when it is done

private:
    struct Loaded {
        std::shared_ptr<const SceneContent> content;
        std::unique_ptr<SceneStart> start;
    };
    std::future<Loaded> loading_;
};

}  // namespace tact
