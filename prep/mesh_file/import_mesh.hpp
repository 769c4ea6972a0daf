// Reads triangle meshes: PLY (.ply, ascii and binary of either byte order), OBJ (.obj), STL (.stl, ascii and binary)
// and OFF (.off, text, also COFF, NOFF and similar), each also as .gz.
//
// Units    as in the file; nothing is scaled or moved.
// Kept     positions and faces; a polygon becomes a fan of triangles. Equal corners of STL are merged. Vertices that no
//          face uses are kept; see cleaned() in prep/mesh.
// Checks   counts against the size of the file before memory is allocated; every index in range, every
//          number finite and at most 1e6 in size; at most 255 corners per face.
// Memory   12 bytes per vertex and 12 per triangle, announced before allocation; STL needs 16 more per vertex while it
//          merges corners. The file is memory-mapped; a compressed file is unpacked into memory, at most
//          4 GiB.  Thread  any but the servo's.
// Fails by StartupError with file, line or element, reason and fix.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "ipc/base/progress.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

inline constexpr std::uint64_t kMeshFileBytesMax = std::uint64_t{1} << 36;
inline constexpr std::uint64_t kMeshUnpackedBytesMax = std::uint64_t{1} << 32;  // of a compressed file
inline constexpr std::uint32_t kMeshElementsMax = std::uint32_t{1} << 28;       // vertices, and triangles

// Reported once, before allocation. For text without counts (STL) both are estimated from its length.
struct MeshNeeds {
    std::size_t vertices, triangles;
    std::uint64_t bytes;  // of the mesh
};
using AnnounceMesh = std::function<void(const MeshNeeds&)>;

struct ImportedMesh {
    TriangleMesh mesh;
    std::string format;  // "PLY binary little endian"
};

ImportedMesh import_mesh(const std::filesystem::path& path, const Progress& progress = {},
                         const AnnounceMesh& announce = {});

// The same from uncompressed bytes in memory, for tests and fuzzing. `ending` selects the format.
ImportedMesh import_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& ending,
                               const Progress& progress = {}, const AnnounceMesh& announce = {});

}  // namespace tact
