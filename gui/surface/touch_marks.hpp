// What a hand does to a surface: where the tool would be without it, and what holds it off.
//
// Probe    a ball where the hand holds the tool, as large as the tool or as can just be seen, and a thin line from
//          there to the proxy: the spring that is felt
// Normals  an arrow for each plane that holds the proxy, from where it is touched, as long as it pushes
// Frame    scene, ångström. Pure functions; SurfaceLayer draws what they give, over the surface.
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

// centre_model_m: where the scene's origin is; size_a, arrow_a_per_n: as of second_hand.hpp.
[[nodiscard]] TubeMesh build_touch_marks(const DrawnTouch& touch, const Vec3& centre_model_m, float size_a,
                                         float arrow_a_per_n);

}  // namespace tact
