// Triangle meshes from files: PLY (.ply, ascii and binary of either byte order), OBJ (.obj), STL (.stl, ascii
// and binary) and OFF (.off, with COFF, NOFF and their like, text), each also as .gz.
//
// Units    as they are in the file; nothing is scaled or moved.
// Kept     positions and faces; a face with more corners becomes a fan of triangles. The corners of STL are
//          joined where they are equal. Vertices that no face uses stay; see cleaned() in prep/mesh.
// Checks   counts against the size of the file before anything is allocated; every index in range, every
//          number finite and below 1e6 in size; a face has no more than 255 corners.
// Memory   12 bytes a vertex and 12 a triangle, told before they are taken; STL 16 a vertex more while it
//          joins corners. The file is mapped, not held; one that is packed is unpacked into memory, no more
//          than 4 GiB.  Thread  any but the servo's.
// Fails by StartupError naming the file, the line or element, the reason and the fix.
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
inline constexpr std::uint64_t kMeshUnpackedBytesMax = std::uint64_t{1} << 32;  // of a packed file
inline constexpr std::uint32_t kMeshElementsMax = std::uint32_t{1} << 28;       // vertices, and triangles

// Told once, before memory is taken. Of text without counts (STL) both are estimated from its length.
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

// The same from bytes in memory (not packed), for tests and fuzzing. `ending` decides the format.
ImportedMesh import_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& ending,
                               const Progress& progress = {}, const AnnounceMesh& announce = {});

}  // namespace tact
