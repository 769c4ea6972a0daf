// Where a body starts: at the position in its file, or beside the map if that is far from it.
//
// Frame    model, metres
// Thread   any but the servo thread
#pragma once

#include <span>
#include <vector>

#include "ipc/scene/density/structure.hpp"

namespace tact {

// Distance of a point from the box of the map; 0 inside.
[[nodiscard]] double outside_m(const DensityGrid& grid, const Vec3& at_model_m);
// The hand reaches the map, and half its largest width around it.
[[nodiscard]] bool in_reach(const DensityGrid& grid, const Vec3& at_model_m);
// An atom of the structure lies in the box of the map.
[[nodiscard]] bool overlaps(const DensityGrid& grid, const Structure& structure, const Pose& T_model_body);

// A ball around the atoms of a body.
struct BodyBall {
    Vec3 centre_model_m = Vec3::Zero();
    double radius_m = 0.0;
};
[[nodiscard]] BodyBall ball_of(const Structure& structure, const Pose& T_model_body);

// Axes as in the file; beside the box of the map in the direction of +x, clear of the other bodies.
[[nodiscard]] Pose place_beside(const DensityGrid& grid, const Structure& structure,
                                std::span<const BodyBall> others);

// Of one body for each structure: at the position in its file if the hand reaches it there, else beside the map.
[[nodiscard]] std::vector<Pose> start_places(const DensityGrid& grid, std::span<const Structure> structures);

}  // namespace tact
