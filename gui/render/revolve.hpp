// Surfaces of revolution as triangles: rings of a profile about an axis.
#pragma once

#include <Eigen/Core>
#include <span>

#include "gui/render/tube.hpp"

namespace tact {

// One ring of the profile: its place along the axis, its radius, and how much the normal leans along the axis
// (-1 backwards, 0 outwards, 1 forwards). Two rings at one place make an edge.
struct ProfileRing {
    float at_a, radius_a, lean;
};

// Adds them to the mesh. Unit ångström, frame of from_a; the axis is of length 1.
void add_revolved(TubeMesh& mesh, std::span<const ProfileRing> rings, const Eigen::Vector3f& from_a,
                  const Eigen::Vector3f& axis, const Rgb8& colour);

}  // namespace tact
