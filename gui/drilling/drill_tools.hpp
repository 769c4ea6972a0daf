// Meshes of the drilling instruments: a burr (fluted, or smooth if small), and a suction tube.
//
// Frame   tool (origin at its head's centre, shaft along +z), ångström of the scene. Pure.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

enum class DrillHead : std::uint8_t { sphere, cylinder, cone, tube };

struct DrawnDrillTool {
    Pose T_model_tool;
    DrillHead head = DrillHead::sphere;
    bool diamond = false;  // grains instead of flutes
    // Lengths of the model, metres.
    double radius_m = 0.0, length_m = 0.0, tip_radius_m = 0.0, shaft_radius_m = 0.0, shaft_length_m = 0.0;
    double turned_rad = 0.0;  // about +z, as drawn

    // True if the same mesh serves.
    [[nodiscard]] bool same_shape(const DrawnDrillTool& o) const {
        return head == o.head && diamond == o.diamond && radius_m == o.radius_m && length_m == o.length_m &&
               tip_radius_m == o.tip_radius_m && shaft_radius_m == o.shaft_radius_m &&
               shaft_length_m == o.shaft_length_m;
    }
};

// head: what lights up near a structure; a tube has none.
struct DrillToolMesh {
    TubeMesh head, rest;
};
[[nodiscard]] DrillToolMesh build_drill_tool(const DrawnDrillTool& tool);

}  // namespace tact
