// Triangle mesh of an arrow along a vector, for forces.
#pragma once

#include <Eigen/Core>

#include "gui/render/tube.hpp"

namespace tact {

inline constexpr Rgb8 kForceColour{255, 92, 92};  // same as in the legend

// Unit ångström, frame of from_a. The mesh is empty if the arrow is shorter than it is thick.
[[nodiscard]] TubeMesh build_arrow(const Eigen::Vector3f& from_a, const Eigen::Vector3f& along_a,
                                   float thickness_a, const Rgb8& colour);

}  // namespace tact
