// From what was read to what the panels show.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/render/scene_content.hpp"
#include "ipc/topics/event.hpp"

namespace tact {

// What every system's scene has; the rest is its system's to tell.
[[nodiscard]] SceneState describe(const SceneContent& content);
[[nodiscard]] EventLine describe(const EventTopic& event);

}  // namespace tact
