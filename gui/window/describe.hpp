// Converts records to the contents of panels.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/render/scene_content.hpp"
#include "ipc/topics/event.hpp"

namespace tact {

// The part common to all systems; the scene's system adds the rest.
[[nodiscard]] SceneState describe(const SceneContent& content);
[[nodiscard]] EventLine describe(const EventTopic& event);

}  // namespace tact
