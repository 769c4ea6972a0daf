#include "gui/window/scene_loader.hpp"

#include <chrono>
#include <exception>

#include "gui/window/load_scene.hpp"
#include "gui/window/systems.hpp"

namespace tact {

bool SceneLoader::start(const std::string& path) {
    if (running()) return false;
    loading_ = std::async(std::launch::async, [path] {
        Loaded loaded{load_scene(path), {}};
        const SystemRow& row = system_row(loaded.content->meta.kind);
        if (row.start != nullptr) loaded.start = row.start(*loaded.content);
        return loaded;
    });
    return true;
}

std::optional<SceneLoader::Outcome> SceneLoader::poll() {
    if (!running() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    try {
        Loaded loaded = loading_.get();
        return Outcome{std::move(loaded.content), std::move(loaded.start), {}};
    } catch (const std::exception& e) {
        return Outcome{nullptr, {}, e.what()};
    }
}

}  // namespace tact
