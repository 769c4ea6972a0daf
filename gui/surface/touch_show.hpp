// What is drawn of a hand on a surface, from what the controller says of it; nothing where it says nothing that can be used.
//
// Thread   frame thread
#pragma once

#include <optional>

#include "gui/link/controller.hpp"
#include "gui/render/drawn_hand.hpp"
#include "gui/render/scene_content.hpp"
#include "gui/surface/touch_marks.hpp"

namespace tact {

// A pen whose tip is the proxy: where the tool would be, were the surface hard.
std::optional<DrawnHand> touching_pen(const Controller& controller, const SceneContent& content);
// A tool that is a mesh is drawn as it is, where the proxy is.
std::optional<Pose> touching_tool(const Controller& controller, const SceneContent& content);
// Where the tool would be without the surface, and what holds it off.
std::optional<DrawnTouch> touch_marks(const Controller& controller);

}  // namespace tact
