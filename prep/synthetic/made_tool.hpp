// Tools made in code to touch with, true to size: the hand's point is the origin, their tips point down (-y).
//
// scaler   as dentists hold it: a handle, and below it a shank that bends to a thin tip
// block    16 x 8 x 12 mm: what torque is can be felt with it at once
// Unit     metres
#pragma once

#include <array>
#include <string>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr std::array<const char*, 2> kMadeTools{"scaler", "block"};

// Empty where there is none of that name.
TriangleMesh made_tool(const std::string& name);

}  // namespace tact
