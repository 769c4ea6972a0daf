// Tool paths over a surface, for measurements.
//
// slide   meanders, 1.5 +- 0.5 mm deep, at about 55 mm/s at pace 1
// orbit   circles around an axis, 1.5 mm deep, at about 60 mm/s
// tap     from 3 mm outside to 2 mm inside and back, three times per second, while it slowly moves along
//         The three need a surface that is star-shaped about the origin.
// wander  on any surface, from inside or outside: at a given speed and depth, with turns, and lifted off for a
//         moment every two seconds
// Begins  3 mm outside, and reaches its depth after a quarter of a second.
// Unit    metres of the model, one position per millisecond
#pragma once

#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact::launch {

inline constexpr double kTouchStepS = 1e-3;  // between two positions

enum class TouchWay { slide, orbit, tap };

// pace: factor on the speed.
std::vector<Vec3> touch_path_m(const SurfaceMesh& surface, TouchWay way, double pace, std::size_t samples);

struct Wander {
    double speed_m_s = 0.055, depth_m = 1.5e-3;
    std::uint64_t seed = 1;  // for the start and the turns
    double even_m = 1.5e-3;  // the normal is averaged over this path length
};
struct WanderPlace {
    Vec3 point_m, outward;  // unit vector: the side of the hand
};
std::vector<WanderPlace> wander(const SurfaceMesh& surface, const Wander& how, std::size_t samples);
std::vector<Vec3> wander_m(const SurfaceMesh& surface, const Wander& how, std::size_t samples);

}  // namespace tact::launch
