// Reads a tool path from text: one line x y z per millisecond; ignores empty lines and lines that begin with #.
#pragma once

#include <filesystem>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::launch {

// Returns metres. unit_m: unit of the file in metres. Fails by StartupError if the file cannot be read, a line is not a
// position, or there are more than ten million positions.
[[nodiscard]] std::vector<Vec3> read_positions(const std::filesystem::path& file, double unit_m);

}  // namespace tact::launch
