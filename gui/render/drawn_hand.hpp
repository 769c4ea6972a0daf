// A hand that holds no body: a pen, and the wall that its tip touches.
//
// Pen      tip at the hand, held as in a right hand. A second hand's is violet, unlike any body and unlike the first
//          hand's force; an only hand's is of steel, with its force in the usual colour
// Wall     two rings in the plane of the wall that pushes the tip back, and an arrow for the force
// Frame    scene, ångström. Pure functions; gui/render/scene_view.cpp draws the meshes.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

inline constexpr Rgb8 kSecondHandColour{178, 132, 255}, kSecondGripColour{118, 104, 158};
inline constexpr Rgb8 kSteelColour{176, 186, 200}, kSteelGripColour{96, 106, 122};

struct DrawnHand {
    Pose T_model_hand;
    Vec3 force_world_n = Vec3::Zero();  // on the hand
    bool at_wall = false;
    bool pen = true;  // false: only the force, because another tool is drawn there
    Rgb8 pen_colour = kSecondHandColour, grip_colour = kSecondGripColour, force_colour = kSecondHandColour;
};

// `tip_a` in the scene frame; `size_a`: radius of the scene shown; `arrow_a_per_n` as for the first hand's arrow.
[[nodiscard]] TubeMesh build_second_hand(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a,
                                         float arrow_a_per_n);
// Rings of the wall; empty if the hand touches none. To be drawn unlit: the dark side of a wall may face the eye.
[[nodiscard]] TubeMesh build_touched_wall(const DrawnHand& hand, const Eigen::Vector3f& tip_a, float size_a);
inline constexpr Rgb8 kTouchedWallColour{222, 204, 255};

}  // namespace tact
