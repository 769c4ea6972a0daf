// The instruments of drilling as solid bodies: a fluted burr, a smooth one where it is small, and the tube of a suction tube.
//
// Frame   tool (its head's centre is the origin, the shaft leaves along +z), ångström of the scene. Pure.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

enum class DrillHead : std::uint8_t { sphere, cylinder, cone, tube };

struct DrawnDrillTool {
    Pose T_model_tool;
    DrillHead head = DrillHead::sphere;
    // Lengths of the model, metres.
    double radius_m = 0.0, length_m = 0.0, tip_radius_m = 0.0, shaft_radius_m = 0.0, shaft_length_m = 0.0;
    double turned_rad = 0.0;  // about +z, as it is drawn

    // Whether the same mesh serves.
    [[nodiscard]] bool same_shape(const DrawnDrillTool& o) const {
        return head == o.head && radius_m == o.radius_m && length_m == o.length_m &&
               tip_radius_m == o.tip_radius_m && shaft_radius_m == o.shaft_radius_m &&
               shaft_length_m == o.shaft_length_m;
    }
};

[[nodiscard]] TubeMesh build_drill_tool(const DrawnDrillTool& tool);

}  // namespace tact
