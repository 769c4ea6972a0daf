// Triangle meshes as PLY files, to hand them to tact-prep and back.
//
// Written  ASCII, positions as they are, a face list of three indices
// Read     ASCII or binary_little_endian; vertices with x, y, z among any scalar properties, faces with
//          one list. Every count and index is checked. Hostile files: StartupError, never more than the
//          file holds.
#pragma once

#include <filesystem>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact::launch {

void write_ply(const TriangleMesh& mesh, double scale, const std::filesystem::path& path);
// Positions are divided by `scale` again.
[[nodiscard]] TriangleMesh read_ply(const std::filesystem::path& path, double scale);

}  // namespace tact::launch
