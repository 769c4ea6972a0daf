// Writes a triangle mesh as a binary little-endian PLY file: float x, y, z and lists of three int corners.
//
// The file is whole or absent: it is written under a temporary name in the same folder, then renamed.
// Fails by StartupError with file, reason and fix.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

// One colour and one number a vertex; empty: none.
struct PlyColours {
    std::vector<std::array<std::uint8_t, 3>> rgb;
    std::vector<float> quality;
    std::string comment;  // one line: what they are
};

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const PlyColours& colours = {});

}  // namespace tact
