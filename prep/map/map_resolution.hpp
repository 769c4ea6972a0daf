// What is said of a resolution that cannot be used, and of one that nobody gave: it is never guessed, because forces, search and
// scores depend on it.
#pragma once

#include <string>

#include "ipc/base/pose.hpp"

namespace tact {

// StartupError unless it is one of a map: 0.5 to 200 Å. option: that gives it.
void check_resolution(double resolution_m, const std::string& option);

// StartupError "its resolution is unknown", with the range that the voxels suggest.
[[noreturn]] void refuse_unknown_resolution(const std::string& map, const Vec3& voxel_m);

}  // namespace tact
