// The cut through a progressive mesh that is drawn: walks to any vertex count and tells what to upload.
//
// Buffers   vertex() and index() are prefixes of two blocks that never move; give the GPU buffers room for
//           mesh.vertices() vertices and 3 * mesh.triangles() indices once, then upload the changes.
// Repeats   the content depends on the vertex count alone, bit for bit, however it was reached.
// Time      set_vertices() takes single steps or rebuilds by the collapse map, whichever its cost model says
//           is cheaper: 15 to 70 ns a step, at most about 15 ns per vertex of the mesh. It never allocates.
// Thread    a MeshCut belongs to one thread; the mesh may be shared and must outlive it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/assets/progressive_mesh.hpp"
#include "ipc/base/huge_pages.hpp"

namespace tact {

struct MeshRange {
    std::uint32_t first, count;  // in vertices, or in indices
};
struct MeshChanges {
    std::span<const MeshRange> vertex, index;  // rising, not overlapping; inside vertex() and index()
};

class MeshCut {
public:
    explicit MeshCut(const ProgressiveMesh& mesh);  // starts at the base, everything changed

    // Moves to `wanted` vertices, clamped to [vertices_min, vertices] of the mesh. Returns what it has now.
    std::uint32_t set_vertices(std::uint32_t wanted) noexcept;

    [[nodiscard]] std::uint32_t vertices() const { return level_; }
    [[nodiscard]] std::uint32_t triangles() const { return mesh_->triangles(level_); }
    [[nodiscard]] float error_m() const { return mesh_->error_m(level_); }
    [[nodiscard]] std::span<const MeshVertex> vertex() const { return {vertex_.data(), level_}; }
    [[nodiscard]] std::span<const std::uint32_t> index() const {
        return {index_.data(), std::size_t{3} * triangles()};
    }

    // What differs from the last call of changes(); the spans hold until the next one. Ranges are whole
    // blocks of 256 vertices or 1024 indices, as uploads of a few kilobytes cost no more than smaller ones.
    MeshChanges changes() noexcept;

private:
    void step_down() noexcept;
    void step_up() noexcept;
    void rebuild(std::uint32_t wanted) noexcept;
    void rebuild_vertices(std::uint32_t wanted) noexcept;
    void rebuild_index(std::uint32_t wanted) noexcept;

    const ProgressiveMesh* mesh_;
    std::uint32_t level_;
    HugeVector<MeshVertex> vertex_;
    HugeVector<std::uint32_t> index_;
    HugeVector<std::uint32_t> scratch_;  // of rebuild, one per vertex
    std::vector<std::uint8_t> vertex_dirty_, index_dirty_;
    std::vector<MeshRange> vertex_range_, index_range_;
};

}  // namespace tact
