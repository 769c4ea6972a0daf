// A mesh that can be drawn with any number of vertices between a coarse base and the original.
//
// Vertices are numbered so that level n consists of vertices 0 … n-1: contraction i (level i+1 -> i) removes
// vertex i into parent(i) < i, which moves. Triangles are ordered by how long they live, so those of a level
// are a prefix too; one disappears where two of its corners meet, not earlier. Nothing else is asked of a
// contraction: the two need not share an edge, and the surface may be of any kind.
// Built by prep/mesh/progressive.hpp, walked by ipc/scene/mesh/mesh_cut.hpp. Section MESH.
//
// Frame    model, metres.  Thread   immutable after construction.
// Fails by StartupError: every count and index is checked here, so that walking needs no check.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/mesh/mesh_patches.hpp"

namespace tact {

// Where an index of a vertex or triangle says that there is none.
inline constexpr std::uint32_t kNoIndex = UINT32_MAX;

struct TriangleMesh {
    std::vector<float> position_m;        // 3 per vertex
    std::vector<std::uint32_t> triangle;  // 3 per triangle, counter-clockwise seen from outside
    [[nodiscard]] std::size_t vertices() const { return position_m.size() / 3; }
    [[nodiscard]] std::size_t triangles() const { return triangle.size() / 3; }
};

// As it lies in a file, and in a buffer of what has one level alone: stride 20, position 3 x GL_FLOAT at 0,
// normal 4 x GL_SHORT normalized at 12.
struct MeshVertex {
    std::array<float, 3> position_m;
    std::array<std::int16_t, 4> normal;  // unit vector, outward, times 32767; the last is 0

    friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};
static_assert(sizeof(MeshVertex) == 20);

// As it is walked and drawn: stride 16, position 3 x GL_FLOAT at 0, normal GL_INT_2_10_10_10_REV normalized
// at 12. Four to a line of the cache; a normal is off by at most 0.1 degrees.
struct PackedVertex {
    std::array<float, 3> position_m;
    std::uint32_t normal;  // unit vector, outward, times 511: x in bits 0 to 9, y 10 to 19, z 20 to 29

    friend bool operator==(const PackedVertex&, const PackedVertex&) = default;
};
static_assert(sizeof(PackedVertex) == 16);
[[nodiscard]] PackedVertex pack(const MeshVertex& vertex);
[[nodiscard]] std::array<float, 3> unit_normal(const PackedVertex& vertex);

// What prep hands over and the section holds. With N vertices, base B: N-B contractions, T triangles.
struct ProgressiveMeshData {
    std::uint32_t base_vertices = 0;
    std::vector<MeshVertex> vertex;       // N: the original mesh
    std::vector<std::uint32_t> parent;    // N-B: [k] of vertex B+k, smaller than B+k
    std::vector<MeshVertex> merged;       // N-B: [k] the parent after vertex B+k went into it
    std::vector<float> error_m;           // N-B+1: [k] of level B+k, falling, last 0 (see progressive.hpp)
    std::vector<std::uint32_t> triangle;  // 3 T: the original mesh, longest lived first
    std::vector<std::uint32_t> triangle_count;  // N-B+1: [k] of level B+k, rising, last T
};

class ProgressiveMesh {
public:
    explicit ProgressiveMesh(ProgressiveMeshData data);

    [[nodiscard]] std::uint32_t vertices() const {
        return base_ + static_cast<std::uint32_t>(parent_.size());
    }
    [[nodiscard]] std::uint32_t vertices_min() const { return base_; }
    [[nodiscard]] std::uint32_t triangles() const { return triangle_count_.back(); }
    // Of a level n in [vertices_min, vertices].
    [[nodiscard]] std::uint32_t triangles(std::uint32_t n) const { return triangle_count_[n - base_]; }
    [[nodiscard]] float error_m(std::uint32_t n) const { return error_m_[n - base_]; }
    // visit(const PackedVertex&) for every vertex of the original mesh in turn.
    template <class Visit>
    void each_original(Visit&& visit) const {
        for (std::uint32_t i = 0; i < spans_[0].version_end; ++i)
            if (version_level_[i] == UINT32_MAX) visit(version_[i]);
    }
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    friend class MeshCut;
    // A triangle that contraction k brings back: its corners are vertex B+k, the parent and another one.
    struct Birth {
        std::uint32_t place;           // of its first corner at the level that has it, in the index buffer
        std::uint32_t other_and_turn;  // the other vertex; from bit 29 on which corner is which, see birth()
    };
    // A run of levels, at most halved from the first to the last.
    struct Span {
        std::uint32_t top;                         // its first level; it ends with the top of the next
        std::uint32_t version_first, version_end;  // in version_
    };
    void order_versions(const ProgressiveMeshData& data);
    [[nodiscard]] const Span& span_of(std::uint32_t level) const {
        std::size_t i = 0;
        while (i + 1 < spans_.size() && spans_[i + 1].top >= level) ++i;
        return spans_[i];
    }
    // The version of vertex v that level v+1, its coarsest, shows; for v >= B-1.
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
    // Span by span, in it one vertex after the other, all that the vertex looks like there, finest first.
    std::vector<Span> spans_;
    HugeVector<PackedVertex> version_;         // about 3N
    HugeVector<std::uint32_t> version_level_;  // and one; the finest level that shows it, UINT32_MAX: the top
    std::vector<std::uint32_t> version_coarsest_;  // N-B+1, see coarsest_version()
    std::vector<std::uint32_t> version_merged_;    // N-B: [k] what the parent is after contraction k
    MeshPatches patches_;
    std::vector<Birth> birth_;                 // of all triangles that the base has not, in their order
    std::vector<std::uint32_t> change_first_;  // N-B+1: [k] where the corners that contraction k moves begin
    std::vector<std::uint32_t> change_;        // places in the index buffer of those corners, at level B+k+1
};

void write_mesh(SceneWriter& out, std::uint32_t index, const ProgressiveMeshData& data);
ProgressiveMeshData read_mesh_data(const SceneFile& file,
                                   std::uint32_t index);  // lengths are checked, no more
ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index);

}  // namespace tact
