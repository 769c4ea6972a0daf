// The inner loops of MeshCut's rebuild, one function per instruction set. Private to ipc/scene/mesh and its
// tests.
//
// Layout   as in ProgressiveMesh and MeshPatches
// Thread   any; no allocation, linear in the count
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

struct MeshKernels {
    const char* name;
    bool (*runs_here)();
    // Lists the versions in [0, end) that level `wanted` shows: those with level[i] >= wanted that are the
    // last of their vertex or are followed by a coarser one. level has end + 1 entries. Returns their
    // number; the list needs room for kListSlack more entries.
    std::uint32_t (*list_versions)(const std::uint32_t* level, std::uint32_t end, std::uint32_t wanted,
                                   std::uint32_t* list);
    // The collapse map of a level for the `count` vertices from it on, with their parents in parent[]:
    // map[i] is the vertex below `level` into which vertex level + i was contracted.
    void (*follow)(const std::uint32_t* parent, std::uint32_t level, std::uint32_t count, std::uint32_t* map);
    // vertex[corner] for 3 corners per triangle; (0, 0, 0) for triangles with two equal ones. With `past`,
    // uses non-temporal stores if `to` is a multiple of 64 bytes, as nothing reads the result soon.
    void (*look_up)(const std::uint16_t* corner, std::uint32_t triangles, const std::uint32_t* vertex,
                    std::uint32_t* to, bool past);
};
inline constexpr std::size_t kListSlack = 16;

// Fastest first; the last, "generic", runs everywhere.
extern const MeshKernels kMeshKernels[];
extern const std::size_t kMeshKernelCount;
[[nodiscard]] const MeshKernels& fastest_mesh_kernels();

}  // namespace tact
