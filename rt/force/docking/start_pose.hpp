// A random pose at a given distance and angle from another.
//
// Thread   any; no allocation.
#pragma once

#include "ipc/base/random.hpp"

namespace tact {

// Returns home moved by offset_m in a random direction and rotated by angle_rad about a random axis through its
// origin.
inline Pose start_pose(const Pose& home, double offset_m, double angle_rad, std::uint64_t seed) {
    SeededRandom random(seed);
    const Vec3 direction = random.direction(), axis = random.direction();
    const Quat turn(Eigen::AngleAxisd(angle_rad, axis));
    return {home.p_m + offset_m * direction, (turn * home.q).normalized()};
}

}  // namespace tact
