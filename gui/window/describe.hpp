// Converts records to the contents of panels.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/render/scene_content.hpp"
#include "ipc/topics/event.hpp"

namespace tact {

// The part common to all systems; the scene's system adds the rest.
[[nodiscard]] SceneState describe(const SceneContent& content);
// levels: for the names of paths; null: unknown.
[[nodiscard]] EventLine describe(const EventTopic& event, const LevelsTopic* levels = nullptr);

}  // namespace tact
