// Triangle meshes from files: PLY (.ply, ascii and binary of either byte order), OBJ (.obj) and STL (.stl,
// ascii and binary), each also as .gz.
//
// Units    as they are in the file; nothing is scaled or moved.
// Kept     positions and faces; a face with more corners becomes a fan of triangles. The corners of STL are
//          joined where they are equal. Vertices that no face uses stay; see cleaned() in prep/mesh.
// Checks   counts against the size of the file before anything is allocated; every index in range, every
//          number finite and below 1e6 in size; a face has no more than 255 corners.
// Memory   the file, unpacked, no more than 4 GiB, and what is kept of it.  Thread  any but the servo's.
// Fails by StartupError naming the file, the line or element, the reason and the mend.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/assets/progressive_mesh.hpp"
#include "ipc/base/progress.hpp"

namespace tact {

inline constexpr std::uint64_t kMeshFileBytesMax = std::uint64_t{1} << 32;
inline constexpr std::uint32_t kMeshElementsMax = std::uint32_t{1} << 28;  // vertices, and triangles

struct ImportedMesh {
    TriangleMesh mesh;
    std::string format;  // "PLY binary little endian"
};

ImportedMesh import_mesh(const std::filesystem::path& path, const Progress& progress = {});

// The same from bytes in memory (not packed), for tests and fuzzing. `ending` decides the format.
ImportedMesh import_mesh_bytes(std::vector<char> bytes, const std::string& name, const std::string& ending,
                               const Progress& progress = {});

}  // namespace tact
