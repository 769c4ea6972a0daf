// Poses of a hand as text: a header line `t_s,x_m,y_m,z_m,qx,qy,qz,qw`, then one line per pose.
//
// Frames   T_world_tool: metres and a unit quaternion (its norm may be off by a tenth; it is normalized).
// Takes    empty lines, comment lines that start with #, either line ending.
// Fails by StartupError with line and cause.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::launch {

struct TimedPose {
    double t_s = 0.0;
    Pose T_world_tool;
};

inline constexpr std::size_t kPosesMax = 2'000'000;

std::vector<TimedPose> read_poses_csv(const std::filesystem::path& path);
std::vector<TimedPose> read_poses_csv(std::istream& in, const std::string& name);

}  // namespace tact::launch
