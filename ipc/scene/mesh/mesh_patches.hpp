// The triangles of a progressive mesh in patches, each with index lists at a few levels: the data drawn by
// a MeshCut.
//
// A patch is a group of kTriangles adjacent triangles of the original surface with permanent places in the
// index buffer. At a level it shows one of its lists: the triangles that still exist at a certain finer
// level, in an order optimized for the vertex cache, with triangles removed since then made degenerate.
// Consecutive lists differ by a factor of 2, and each patch changes lists at different levels, so that a
// walk meets the changes one by one.
//
// The triangles of a patch are numbered by lifetime, so a list contains the first few of them.
//
// Frame    none: numbers of vertices and triangles
// Thread   immutable after construction
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"

namespace tact {

struct ProgressiveMeshData;

struct MeshPatches {
    static constexpr std::uint32_t kShift = 12, kTriangles = 1U << kShift;
    static constexpr std::uint16_t kElsewhere = UINT16_MAX;  // above the vertex count of a list

    struct List {
        std::uint32_t level;  // its finest level; the next list of the patch takes over at its own level
        std::uint32_t first;  // of its first triangle, in corner and slot
        std::uint32_t vertex_first;  // in vertex and parent
        std::uint16_t triangles, vertices;
    };
    struct Change {
        std::uint32_t level, patch;  // from this level down, the patch shows its next list
    };

    std::vector<std::uint32_t> list_first;  // patches + 1 entries, in list
    std::vector<List> list;                 // patch by patch, levels decreasing
    HugeVector<std::uint16_t> corner;       // 3 per triangle, numbers in the vertices of the list
    HugeVector<std::uint16_t> slot;         // of triangle i of the patch, at first + i: its place in the list
    HugeVector<std::uint32_t> vertex;       // of the mesh, at the level of the list; increasing in a list
    HugeVector<std::uint16_t> parent;       // of that vertex, as a number in the list, or kElsewhere
    std::vector<Change> change;             // levels increasing

    [[nodiscard]] std::uint32_t patches() const { return static_cast<std::uint32_t>(list_first.size() - 1); }
    // The list shown by a patch at a level.
    [[nodiscard]] std::uint32_t list_at(std::uint32_t patch, std::uint32_t level) const {
        std::uint32_t i = list_first[patch];
        while (i + 1 < list_first[patch + 1] && list[i + 1].level >= level) ++i;
        return i;
    }
    // For a PatchedMesh::number: place of the triangle's first corner at a level, in the index buffer.
    [[nodiscard]] std::uint32_t place_at(std::uint32_t number, std::uint32_t level) const {
        const std::uint32_t patch = number >> kShift;
        const std::size_t triangle = list[list_at(patch, level)].first + (number & (kTriangles - 1));
        return 3 * ((patch << kShift) + slot[triangle]);
    }
    [[nodiscard]] std::size_t memory_bytes() const;
};

// number[t] for triangle t of the data: its patch times kTriangles plus its number in the patch.
struct PatchedMesh {
    MeshPatches patches;
    std::vector<std::uint32_t> number;
};
// Data must have been checked. Throws StartupError if the lists need more than `lifts_max` steps from a
// vertex to its parent, which only a crafted file does.
[[nodiscard]] PatchedMesh make_patches(const ProgressiveMeshData& data, std::uint64_t lifts_max);

}  // namespace tact
