// Walls between air cells: a foam of convex cells about jittered points, with windows from cell to cell.
//
// Also noise that other made volumes are roughened with. Everything follows from the seed and the point.
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

// In [0, 1), of four integers.
double lattice_random(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) noexcept;
// Smooth in [-1, 1], features about one wide.
double lattice_noise(std::uint64_t seed, const Vec3& p) noexcept;

// Distance from p to the middle of the nearest wall, in units of the cells (about one wide); larger where a
// window is.
double cell_wall_distance(std::uint64_t seed, const Vec3& p) noexcept;

}  // namespace tact
