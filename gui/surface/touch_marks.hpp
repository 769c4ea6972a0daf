// Contact marks of a hand on a surface: the unconstrained tool position and the contact forces.
//
// Probe    a ball where the hand holds the tool, as large as the tool or just visible, and a thin line from there to
//          the proxy: the spring of the virtual coupling
// Normals  an arrow for each plane that constrains the proxy, from the contact point, as long as its force
// Frame    scene, ångström. Pure functions; SurfaceLayer draws the meshes over the surface.
#pragma once

#include <array>

#include "gui/render/tube.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

struct DrawnTouch {
    Vec3 probe_model_m = Vec3::Zero(), proxy_model_m = Vec3::Zero();
    double radius_model_m = 0.0;
    std::uint32_t planes = 0;
    std::array<Vec3, 3> normal;
    std::array<double, 3> push_n{};
};

inline constexpr Rgb8 kProbeColour{255, 171, 64};
inline constexpr Rgb8 kNormalColour{120, 220, 255};

// centre_model_m: origin of the scene; size_a, arrow_a_per_n: as in gui/render/drawn_hand.hpp.
[[nodiscard]] TubeMesh build_touch_marks(const DrawnTouch& touch, const Vec3& centre_model_m, float size_a,
                                         float arrow_a_per_n);

}  // namespace tact
