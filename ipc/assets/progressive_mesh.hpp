// A mesh that can be drawn with any number of vertices between a coarse base and the original.
//
// Vertices are numbered so that level n consists of vertices 0 … n-1: contraction i (level i+1 -> i) removes
// vertex i into parent(i) < i, which moves. Triangles are ordered by how long they live, so those of a level
// are a prefix too; one disappears where two of its corners meet, not earlier. Nothing else is asked of a
// contraction: the two need not share an edge, and the surface may be of any kind.
// Built by prep/mesh/progressive.hpp, walked by ipc/assets/mesh_cut.hpp. Section MESH.
//
// Frame    model, metres.  Thread   immutable after construction.
// Fails by StartupError: every count and index is checked here, so that walking needs no check.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/assets/mesh_patches.hpp"
#include "ipc/assets/scene_file.hpp"

namespace tact {

struct TriangleMesh {
    std::vector<float> position_m;        // 3 per vertex
    std::vector<std::uint32_t> triangle;  // 3 per triangle, counter-clockwise seen from outside
    [[nodiscard]] std::size_t vertices() const { return position_m.size() / 3; }
    [[nodiscard]] std::size_t triangles() const { return triangle.size() / 3; }
};

// As it lies in a vertex buffer: stride 20, position 3 x GL_FLOAT at 0, normal 4 x GL_SHORT normalized at 12.
struct MeshVertex {
    std::array<float, 3> position_m;
    std::array<std::int16_t, 4> normal;  // unit vector, outward, times 32767; the last is 0

    friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};
static_assert(sizeof(MeshVertex) == 20);

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
    // Of the original mesh.
    [[nodiscard]] const MeshVertex& vertex(std::uint32_t v) const { return version_[version_first_[v]]; }
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    friend class MeshCut;
    // A triangle that contraction k brings back: its corners are vertex B+k, the parent and another one.
    struct Birth {
        std::uint32_t number;          // as PatchedMesh has it
        std::uint32_t other_and_turn;  // the other vertex; from bit 29 on which corner is which, see birth()
    };
    void order_versions(const ProgressiveMeshData& data);
    void derive_corners(const ProgressiveMeshData& data);
    [[nodiscard]] static Birth birth(std::uint32_t number, const std::array<std::uint32_t, 3>& corners,
                                     std::uint32_t child, std::uint32_t parent);

    std::uint32_t base_;
    std::vector<std::uint32_t> parent_;          // N-B
    std::vector<float> error_m_;                 // N-B+1
    std::vector<std::uint32_t> triangle_count_;  // N-B+1
    // All that a vertex ever looks like, finest first, one vertex after the other: 2N-B versions.
    HugeVector<MeshVertex> version_;
    HugeVector<std::uint32_t> version_level_;  // 2N-B+1: the finest level that shows it; UINT32_MAX: original
    std::vector<std::uint32_t> version_first_;   // N+1: [v] the original of vertex v
    std::vector<std::uint32_t> version_merged_;  // N-B: [k] what the parent is after contraction k
    MeshPatches patches_;
    std::vector<Birth> birth_;                 // of all triangles that the base has not, in their order
    std::vector<std::uint32_t> change_first_;  // N-B+1: [k] where the corners that contraction k moves begin
    std::vector<std::uint32_t> change_;        // those corners: number of the triangle * 4 + corner
};

void write_mesh(SceneWriter& out, std::uint32_t index, const ProgressiveMeshData& data);
ProgressiveMeshData read_mesh_data(const SceneFile& file,
                                   std::uint32_t index);  // lengths are checked, no more
ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index);

}  // namespace tact
