// Walls between air cells: a foam of convex cells around jittered points, with windows between cells.
//
// Also noise that roughens other synthetic volumes. All values depend only on the seed and the point.
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

// Uniform in [0, 1), a hash of seed and lattice point.
double lattice_random(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) noexcept;
// Smooth noise in [-1, 1] with features about 1 wide.
double lattice_noise(std::uint64_t seed, const Vec3& p) noexcept;

// Distance from p to the middle of the nearest wall, in units of the cells (about one wide); larger at a window.
double cell_wall_distance(std::uint64_t seed, const Vec3& p) noexcept;

}  // namespace tact
