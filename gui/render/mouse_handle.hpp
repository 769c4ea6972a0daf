// What the mouse can take, or holds: a ring about the tool, and a line to where the pointer wants it.
//
// Ring     faces the eye, of the same size on the screen at any distance: thin while the pointer is elsewhere, thicker under it and while it
//          holds the tool
// Line     from the tool to a dot at the pointer's target: its length is how far the force holds the tool back
// Frame    scene, ångström. Pure functions; gui/render/scene_view.cpp draws the meshes unlit.
#pragma once

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

enum class HandleState : std::uint8_t { far, near, held };

struct DrawnHandle {
    Vec3 at_model_m = Vec3::Zero();      // of the tool
    Vec3 target_model_m = Vec3::Zero();  // of the pointer; drawn while it holds the tool
    HandleState state = HandleState::far;
    float radius_px = 18.0F;
};

inline constexpr Rgb8 kHandleColour{255, 214, 102};

// a_per_px: size of a pixel at the tool; to_eye: from the tool to the eye, length 1.
[[nodiscard]] TubeMesh build_mouse_handle(const DrawnHandle& handle, const Eigen::Vector3f& at_a,
                                          const Eigen::Vector3f& target_a, const Eigen::Vector3f& to_eye,
                                          float a_per_px);

}  // namespace tact
