// A mesh that can be drawn with any number of vertices between a coarse base and the original.
//
// Vertices are numbered so that level n consists of vertices 0 … n-1: contraction i (level i+1 -> i) removes
// vertex i into parent(i) < i, which moves. Triangles are ordered by how long they live, so those of a level
// are a prefix too. Built by prep/mesh/progressive.hpp, walked by ipc/assets/mesh_cut.hpp. Section MESH.
//
// Frame    model, metres.  Thread   immutable after construction.
// Fails by StartupError: every count and index is checked here, so that walking needs no check.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

    [[nodiscard]] std::uint32_t vertices() const { return static_cast<std::uint32_t>(data_.vertex.size()); }
    [[nodiscard]] std::uint32_t vertices_min() const { return data_.base_vertices; }
    [[nodiscard]] std::uint32_t triangles() const { return data_.triangle_count.back(); }
    // Of a level n in [vertices_min, vertices].
    [[nodiscard]] std::uint32_t triangles(std::uint32_t n) const {
        return data_.triangle_count[n - data_.base_vertices];
    }
    [[nodiscard]] float error_m(std::uint32_t n) const { return data_.error_m[n - data_.base_vertices]; }
    [[nodiscard]] const ProgressiveMeshData& data() const { return data_; }
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    friend class MeshCut;
    void check_counts() const;
    void check_content() const;
    void derive_vertices();
    void derive_corners();

    ProgressiveMeshData data_;
    // Derived, so that a step reads memory in order.
    std::vector<MeshVertex> before_;  // N-B: the parent before vertex B+k goes into it
    std::vector<MeshVertex> child_;   // N-B: vertex B+k when it goes
    // N-B: the vertex that goes into the same parent next, or the parent itself; the one that went before, or
    // UINT32_MAX. Contraction B+k shows at level n when coarser_[k] < n <= B+k.
    std::vector<std::uint32_t> coarser_, finer_;
    std::vector<std::uint32_t> birth_;  // 3 T: corners of a triangle at the lowest level that has it
    std::vector<std::uint32_t>
        change_first_;                   // N-B+1: [k] where the corners that contraction B+k moves begin
    std::vector<std::uint32_t> change_;  // those corners, as places in the index list
};

void write_mesh(SceneWriter& out, std::uint32_t index, const ProgressiveMeshData& data);
ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index);

}  // namespace tact
