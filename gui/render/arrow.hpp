// An arrow of triangles from a point along a vector, for forces.
#pragma once

#include <Eigen/Core>

#include "gui/render/tube.hpp"

namespace tact {

inline constexpr Rgb8 kForceColour{255, 92, 92};  // as the legend has it

// Unit ångström, frame of from_a. An arrow shorter than its own thickness is not drawn: the mesh is empty.
[[nodiscard]] TubeMesh build_arrow(const Eigen::Vector3f& from_a, const Eigen::Vector3f& along_a,
                                   float thickness_a, const Rgb8& colour);

}  // namespace tact
