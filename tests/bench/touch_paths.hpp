// Tool paths over a surface, for measurements.
//
// slide   meanders, 1.5 +- 0.5 mm deep, at about 55 mm/s at pace 1
// orbit   circles around an axis, 1.5 mm deep, at about 60 mm/s at pace 1
// tap     moves from 3 mm outside to 2 mm inside and back, three times per second at pace 1, and slowly along the
//         surface
//         slide, orbit and tap require a surface that is star-shaped about the origin.
// wander  random turns at a given speed and depth on any surface, from inside or outside; lifts off briefly every two
//         seconds
// Start   3 mm outside; slide and orbit reach their depth after a quarter of a second
// Unit    metres of the model, one position per millisecond
#pragma once

#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact::launch {

inline constexpr double kTouchStepS = 1e-3;  // time between two positions

enum class TouchPath { slide, orbit, tap };

// pace: factor on the speed.
std::vector<Vec3> touch_path_m(const SurfaceMesh& surface, TouchPath kind, double pace, std::size_t samples);

struct Wander {
    double speed_m_s = 0.055, depth_m = 1.5e-3;
    std::uint64_t seed = 1;  // random seed for the start and the turns
    double even_m = 1.5e-3;  // the normal is averaged over this path length
};
struct WanderPlace {
    Vec3 point_m, outward;  // outward: unit vector to the side of the hand
};
std::vector<WanderPlace> wander(const SurfaceMesh& surface, const Wander& settings, std::size_t samples);
std::vector<Vec3> wander_m(const SurfaceMesh& surface, const Wander& settings, std::size_t samples);

}  // namespace tact::launch
