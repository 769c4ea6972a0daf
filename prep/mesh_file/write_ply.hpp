// A triangle mesh as a binary PLY file, little endian: float x, y, z and lists of three int corners.
//
// The file is whole or absent: it is written beside its place and then renamed.
// Fails by StartupError naming the file and the reason.
#pragma once

#include <filesystem>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace tact
