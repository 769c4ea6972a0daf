// Writes a triangle mesh as a binary little-endian PLY file: float x, y, z and lists of three int corners.
//
// The file is whole or absent: it is written under a temporary name in the same folder, then renamed.
// Fails by StartupError with file, reason and fix.
#pragma once

#include <filesystem>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace tact
