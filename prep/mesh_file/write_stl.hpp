// Writes a triangle mesh as a binary STL file. header: up to 79 bytes, such as the space that 3D Slicer looks for.
//
// The file is whole or absent: it is written under a temporary name in the same folder, then renamed.
// Fails by StartupError with file, reason and fix.
#pragma once

#include <filesystem>
#include <string>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh, const std::string& header);

}  // namespace tact
