// Surfaces of revolution as triangles: rings of a profile about an axis.
#pragma once

#include <Eigen/Core>
#include <span>

#include "gui/render/tube.hpp"

namespace tact {

// One ring of the profile: position along the axis, radius, and lean of the normal along the axis (-1 backwards, 0
// outwards, 1 forwards). Two rings at one position make an edge.
struct ProfileRing {
    float at_a, radius_a, lean;
};

// Adds the rings to the mesh. Unit ångström, frame of from_a; the axis has length 1.
void add_revolved(TubeMesh& mesh, std::span<const ProfileRing> rings, const Eigen::Vector3f& from_a,
                  const Eigen::Vector3f& axis, const Rgb8& colour);

}  // namespace tact
