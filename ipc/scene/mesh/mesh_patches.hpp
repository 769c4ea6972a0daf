// The triangles of a progressive mesh in patches, each with index lists at a few levels: what a MeshCut
// draws.
//
// A patch is kTriangles neighbours of the original surface and owns their places in the index buffer for
// good. At a level it shows one of its lists: the triangles that a certain finer level still has, in an order
// that is good for the vertex cache, with those that died since then made degenerate. Lists follow each other
// by a ratio of 2, and each patch changes lists at levels of its own, so that a walk meets the changes one by
// one.
//
// The triangles of a patch are numbered by how long they live, so a list has the first few of them.
//
// Frame    none: numbers of vertices and triangles.  Thread   immutable after construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"

namespace tact {

struct ProgressiveMeshData;

struct MeshPatches {
    static constexpr std::uint32_t kShift = 12, kTriangles = 1U << kShift;
    static constexpr std::uint16_t kElsewhere = UINT16_MAX;  // more than a list has vertices

    struct List {
        std::uint32_t
            level;  // the finest that it serves; the next list of the patch serves from its own down
        std::uint32_t first;         // of its first triangle, in corner and slot
        std::uint32_t vertex_first;  // in vertex and parent
        std::uint16_t triangles, vertices;
    };
    struct Change {
        std::uint32_t level, patch;  // at this level and below the patch shows its next list
    };

    std::vector<std::uint32_t> list_first;  // patches + 1, in list
    std::vector<List> list;                 // of a patch in turn, levels falling
    HugeVector<std::uint16_t> corner;       // 3 a triangle, numbers within the vertices of the list
    HugeVector<std::uint16_t> slot;         // of triangle i of the patch, at first + i: its place in the list
    HugeVector<std::uint32_t> vertex;       // of the mesh, at the level of the list; rising in a list
    HugeVector<std::uint16_t> parent;       // of that vertex, as a number within the list, or kElsewhere
    std::vector<Change> change;             // levels rising

    [[nodiscard]] std::uint32_t patches() const { return static_cast<std::uint32_t>(list_first.size() - 1); }
    // The list that a patch shows at a level.
    [[nodiscard]] std::uint32_t list_at(std::uint32_t patch, std::uint32_t level) const {
        std::uint32_t i = list_first[patch];
        while (i + 1 < list_first[patch + 1] && list[i + 1].level >= level) ++i;
        return i;
    }
    // Of a triangle, by its PatchedMesh::number: where its first corner is at a level, in the index buffer.
    [[nodiscard]] std::uint32_t place_at(std::uint32_t number, std::uint32_t level) const {
        const std::uint32_t patch = number >> kShift;
        const std::size_t triangle = list[list_at(patch, level)].first + (number & (kTriangles - 1));
        return 3 * ((patch << kShift) + slot[triangle]);
    }
    [[nodiscard]] std::size_t memory_bytes() const;
};

// number[t], of the data's triangle t: its patch times kTriangles plus its number within that.
struct PatchedMesh {
    MeshPatches patches;
    std::vector<std::uint32_t> number;
};
// Data must have been checked. Throws StartupError where making the lists takes more than `lifts_max` walks
// from a vertex to its parent, as only a crafted file does.
[[nodiscard]] PatchedMesh make_patches(const ProgressiveMeshData& data, std::uint64_t lifts_max);

}  // namespace tact
