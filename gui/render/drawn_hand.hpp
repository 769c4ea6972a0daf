// A hand that holds no body: a pen, and what its tip touches.
//
// Pen      tip where the hand is, held as a right hand holds it. Of a second hand violet, so that it is neither a body
//          nor the first hand's force; the only hand's is of steel, and its force has the force's colour
// Wall     two rings in the plane of the wall that pushes the tip back, and an arrow for the force
// Frame    scene, ångström. Pure functions; gui/render/scene_view.cpp draws what they give.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr Rgb8 kSecondHandColour{178, 132, 255}, kSecondGripColour{118, 104, 158};
inline constexpr Rgb8 kSteelColour{176, 186, 200}, kSteelGripColour{96, 106, 122};

struct DrawnHand {
    Pose T_model_hand;
    Vec3 force_world_n = Vec3::Zero();  // that it feels
    bool at_wall = false;
    bool pen = true;  // false: the force alone, as something else is drawn there
    Rgb8 pen_colour = kSecondHandColour, grip_colour = kSecondGripColour, force_colour = kSecondHandColour;
};

// `tip_a` in the scene, `size_a` the radius of what is shown, `arrow_a_per_n` as the first hand's arrow has it.
[[nodiscard]] TubeMesh build_second_hand(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a,
                                         float arrow_a_per_n);
// The wall's rings; empty where the hand is at none. To be drawn without light: a wall may be seen from its dark
// side.
[[nodiscard]] TubeMesh build_touched_wall(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a);
inline constexpr Rgb8 kTouchedWallColour{222, 204, 255};

}  // namespace tact
