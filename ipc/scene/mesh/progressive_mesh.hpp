// A mesh that can be drawn with any number of vertices between a coarse base and the original.
//
// Vertices are numbered so that level n consists of vertices 0 … n-1: contraction i (level i+1 -> i) merges
// vertex i into parent(i) < i, which moves. Triangles are ordered by lifetime, so those of a level are a
// prefix too; a triangle disappears when two of its corners meet, not earlier. Contractions have no other
// constraint: the two vertices need not share an edge, and the surface may be of any kind. Built by
// prep/mesh/progressive.hpp, used by ipc/scene/mesh/mesh_cut.hpp. Section MESH.
//
// Frame    model, metres
// Thread   immutable after construction
// Errors   StartupError: every count and index is checked here, so that later access needs no check
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/mesh/mesh_patches.hpp"

namespace tact {

// An index that marks a missing vertex or triangle.
inline constexpr std::uint32_t kNoIndex = UINT32_MAX;

struct TriangleMesh {
    std::vector<float> position_m;        // 3 per vertex
    std::vector<std::uint32_t> triangle;  // 3 per triangle, counter-clockwise as viewed from outside
    [[nodiscard]] std::size_t vertices() const { return position_m.size() / 3; }
    [[nodiscard]] std::size_t triangles() const { return triangle.size() / 3; }
};

// As in a file, and in the buffer of a mesh with one level: stride 20, position 3 x GL_FLOAT at 0, normal 4
// x GL_SHORT normalized at 12.
struct MeshVertex {
    std::array<float, 3> position_m;
    std::array<std::int16_t, 4> normal;  // unit vector, outward, times 32767; the last is 0

    friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};
static_assert(sizeof(MeshVertex) == 20);

// As used for level changes and drawing: stride 16, position 3 x GL_FLOAT at 0, normal
// GL_INT_2_10_10_10_REV normalized at 12. Four per cache line; a normal is off by at most 0.1 degrees.
struct PackedVertex {
    std::array<float, 3> position_m;
    std::uint32_t normal;  // unit vector, outward, times 511: x in bits 0 to 9, y 10 to 19, z 20 to 29

    friend bool operator==(const PackedVertex&, const PackedVertex&) = default;
};
static_assert(sizeof(PackedVertex) == 16);
[[nodiscard]] PackedVertex pack(const MeshVertex& vertex);
[[nodiscard]] std::array<float, 3> unit_normal(const PackedVertex& vertex);

// Output of tact-prep, and content of the section. With N vertices, base B: N-B contractions, T triangles.
struct ProgressiveMeshData {
    std::uint32_t base_vertices = 0;
    std::vector<MeshVertex> vertex;       // N: the original mesh
    std::vector<std::uint32_t> parent;    // N-B: [k] of vertex B+k, smaller than B+k
    std::vector<MeshVertex> merged;       // N-B: [k] the parent after the merge of vertex B+k
    std::vector<float> error_m;           // N-B+1: [k] of level B+k, decreasing, last 0 (see progressive.hpp)
    std::vector<std::uint32_t> triangle;  // 3 T: the original mesh, longest lived first
    std::vector<std::uint32_t> triangle_count;  // N-B+1: [k] of level B+k, increasing, last T
};

class ProgressiveMesh {
public:
    explicit ProgressiveMesh(ProgressiveMeshData data);

    [[nodiscard]] std::uint32_t vertices() const {
        return base_ + static_cast<std::uint32_t>(parent_.size());
    }
    [[nodiscard]] std::uint32_t vertices_min() const { return base_; }
    [[nodiscard]] std::uint32_t triangles() const { return triangle_count_.back(); }
    // For a level n in [vertices_min, vertices].
    [[nodiscard]] std::uint32_t triangles(std::uint32_t n) const { return triangle_count_[n - base_]; }
    [[nodiscard]] float error_m(std::uint32_t n) const { return error_m_[n - base_]; }
    // Calls visit(const PackedVertex&) for every vertex of the original mesh in order.
    template <class Visit>
    void each_original(Visit&& visit) const {
        for (std::uint32_t i = 0; i < spans_[0].version_end; ++i)
            if (version_level_[i] == UINT32_MAX) visit(version_[i]);
    }
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    friend class MeshCut;
    // A triangle that undoing contraction k restores: its corners are vertex B+k, the parent and another one.
    struct Birth {
        std::uint32_t place;           // index buffer place of its first corner at the level where it appears
        std::uint32_t other_and_turn;  // the other vertex; from bit 29 on the corner order, see birth()
    };
    // A run of levels; the last is at least half of the first.
    struct Span {
        std::uint32_t top;                         // its first level; the top of the next span ends it
        std::uint32_t version_first, version_end;  // in version_
    };
    void order_versions(const ProgressiveMeshData& data);
    [[nodiscard]] const Span& span_of(std::uint32_t level) const {
        std::size_t i = 0;
        while (i + 1 < spans_.size() && spans_[i + 1].top >= level) ++i;
        return spans_[i];
    }
    // The version of vertex v at level v+1, its coarsest; for v >= B-1.
    [[nodiscard]] std::uint32_t coarsest_version(std::uint32_t v) const {
        return version_coarsest_[v + 1 - base_];
    }
    void derive_corners(const ProgressiveMeshData& data);
    [[nodiscard]] static Birth birth(std::uint32_t place, const std::array<std::uint32_t, 3>& corners,
                                     std::uint32_t child, std::uint32_t parent);

    std::uint32_t base_;
    HugeVector<std::uint32_t> parent_;           // N-B
    std::vector<float> error_m_;                 // N-B+1
    std::vector<std::uint32_t> triangle_count_;  // N-B+1
    // Span by span, vertex by vertex: all versions of the vertex in the span, finest first.
    std::vector<Span> spans_;
    HugeVector<PackedVertex> version_;         // about 3N
    HugeVector<std::uint32_t> version_level_;  // plus one; finest level of the version, UINT32_MAX: the top
    static constexpr std::uint32_t kVersionStride = 1024;
    std::vector<std::uint32_t> version_original_;  // of vertices 0, 1024, …: the original; one more: the end
    std::vector<std::uint32_t> version_coarsest_;  // N-B+1, see coarsest_version()
    std::vector<std::uint32_t> version_merged_;    // N-B: [k] version of the parent after contraction k
    MeshPatches patches_;
    std::vector<Birth> birth_;                 // of all triangles not in the base, in order
    std::vector<std::uint32_t> change_first_;  // N-B+1: [k] start of the corners that contraction k moves
    std::vector<std::uint32_t> change_;        // places in the index buffer of those corners, at level B+k+1
};

void write_mesh(SceneWriter& out, std::uint32_t index, const ProgressiveMeshData& data);
ProgressiveMeshData read_mesh_data(const SceneFile& file,
                                   std::uint32_t index);  // checks only the lengths
ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index);

}  // namespace tact
