// What to draw of a hand on a surface, from the controller's records; empty without usable records.
//
// Thread   frame thread
#pragma once

#include <optional>

#include "gui/link/controller.hpp"
#include "gui/render/drawn_hand.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/surface/touch_marks.hpp"

namespace tact {

// A pen with its tip at the proxy, where the tool would be on a hard surface.
std::optional<DrawnHand> touching_pen(const Controller& controller, const SceneContent& content);
// Pose of a mesh tool, at the proxy.
std::optional<Pose> touching_tool(const Controller& controller, const SceneContent& content);
// The unconstrained tool position and the contact forces.
std::optional<DrawnTouch> touch_marks(const Controller& controller);

}  // namespace tact
