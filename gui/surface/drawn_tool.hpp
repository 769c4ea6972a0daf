// Solid mesh of the tool that touches a surface, shaded smoothly between facets within about 35 degrees.
//
// Frame   tool, ångström. Pure; SurfaceLayer draws it at the proxy.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"

namespace tact {

inline constexpr Rgb8 kToolColour{196, 203, 214};

[[nodiscard]] TubeMesh build_drawn_tool(const TouchTool& tool);

}  // namespace tact
