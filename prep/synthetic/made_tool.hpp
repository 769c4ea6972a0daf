// Synthetic tools in true size: the grip point is the origin, the tip points down (-y).
//
// scaler   a dental scaler: a handle, and below it a shank that bends to a thin tip
// block    16 x 8 x 12 mm: makes torques easy to feel
// Unit     metres
#pragma once

#include <array>
#include <string>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr std::array<const char*, 2> kMadeTools{"scaler", "block"};

// Empty if no tool has this name.
TriangleMesh made_tool(const std::string& name);

}  // namespace tact
