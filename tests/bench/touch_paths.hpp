// Ways of a pass on a surface, for measurements.
//
// slide   wanders about, 1.5 +- 0.5 mm deep, at about 55 mm/s at pace 1
// orbit   once and again around an axis, 1.5 mm deep, at about 60 mm/s
// tap     from 3 mm outside to 2 mm inside and back, three times a second, while it creeps along
//         All of these on a surface that is seen whole from the origin.
// wander  on any surface, inside or out: along it at a given speed and depth, with turns, and away from it for a
//         moment every two seconds
// Begins  3 mm outside, and is as deep as it should be after a quarter of a second.
// Unit    metres of the model, one position each millisecond
#pragma once

#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact::launch {

inline constexpr double kTouchStepS = 1e-3;  // between two positions

enum class TouchWay { slide, orbit, tap };

// pace: how many times as fast.
std::vector<Vec3> touch_path_m(const SurfaceMesh& surface, TouchWay way, double pace, std::size_t samples);

struct Wander {
    double speed_m_s = 0.055, depth_m = 1.5e-3;
    std::uint64_t seed = 1;  // of where it begins and how it turns
    double even_m = 1.5e-3;  // over so much of the way the normal is a mean
};
struct WanderPlace {
    Vec3 point_m, outward;  // unit: the side that the hand is on
};
std::vector<WanderPlace> wander(const SurfaceMesh& surface, const Wander& how, std::size_t samples);
std::vector<Vec3> wander_m(const SurfaceMesh& surface, const Wander& how, std::size_t samples);

}  // namespace tact::launch
