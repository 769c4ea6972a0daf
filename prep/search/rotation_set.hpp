// Rotations spread evenly over all orientations.
//
// Method   super-Fibonacci spirals (Alexa, CVPR 2022): any number of rotations, the same in every run.
// Cover    every rotation is within about cover_rad of one of the set, an angle of rotation; a test measures it.
#pragma once

#include <cstddef>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

[[nodiscard]] std::vector<Quat> rotation_set(std::size_t count);
[[nodiscard]] std::size_t rotations_for_cover(double cover_rad);
[[nodiscard]] double cover_of_rotations_rad(std::size_t count);

}  // namespace tact
