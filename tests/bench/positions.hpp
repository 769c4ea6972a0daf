// A path of a tool as text: x y z a line, a millisecond apart; empty lines and those that begin with # are left out.
#pragma once

#include <filesystem>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::launch {

// In metres; unit_m: of the file. Fails by StartupError: the file cannot be read, a line is no position, or there are
// more than ten million.
[[nodiscard]] std::vector<Vec3> read_positions(const std::filesystem::path& file, double unit_m);

}  // namespace tact::launch
