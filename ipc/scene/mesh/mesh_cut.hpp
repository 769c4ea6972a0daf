// The cut through a progressive mesh that is drawn: walks to any vertex count and tells what to upload.
//
// Buffers   vertex() and index() are whole blocks that never move; make GPU buffers of their sizes once, then
//           upload the changes and draw the ranges of draws(). Some of the triangles in those are degenerate
//           (0, 0, 0). Vertices from vertices() on are not used.
// Repeats   all that is drawn depends on the vertex count alone, bit for bit, however it was reached.
// Time      single steps, or a rebuild by the collapse map, whichever its cost model says is cheaper: 20 to
//           60 ns a step, at most about 10 ns per vertex of the mesh. Nothing is ever allocated.
// Thread    a MeshCut belongs to one thread; the mesh may be shared and must outlive it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "ipc/scene/mesh/changed_blocks.hpp"
#include "ipc/scene/mesh/mesh_kernels.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct MeshChanges {
    std::span<const MeshRange> vertex, index;  // rising, apart; in vertices, in indices
};

class MeshCut {
public:
    explicit MeshCut(const ProgressiveMesh& mesh);  // starts at the base, everything changed

    // Moves to `wanted` vertices, clamped to [vertices_min, vertices] of the mesh. Returns what it has now.
    std::uint32_t set_vertices(std::uint32_t wanted) noexcept;
    // The same within a budget: at once where steps or a rebuild, and the sending of what they change, fit by
    // the cost model; otherwise as many steps towards it as fit, at least kStepsMin. Repeat until there.
    std::uint32_t approach(std::uint32_t wanted, double budget_ns) noexcept;
    static constexpr std::uint32_t kStepsMin = 256;
    // What set_vertices() would cost by the model, sending included.
    [[nodiscard]] double whole_ns(std::uint32_t wanted) const noexcept;
    // What the last of these calls costs by the model, sending included.
    [[nodiscard]] double cost_ns() const { return cost_ns_; }

    [[nodiscard]] std::uint32_t vertices() const { return level_; }
    [[nodiscard]] std::uint32_t triangles() const { return mesh_->triangles(level_); }
    [[nodiscard]] float error_m() const { return mesh_->error_m(level_); }
    [[nodiscard]] std::span<const PackedVertex> vertex() const { return vertex_; }
    [[nodiscard]] std::span<const std::uint32_t> index() const { return index_; }
    // Parts of index() to draw, rising; some may be empty.
    [[nodiscard]] std::span<const MeshRange> draws() const { return draw_; }

    // What differs from the last call of changes(); the spans hold until the next one. Ranges are whole
    // blocks of 16 vertices or 64 indices (256 bytes), joined over gaps of up to 512 bytes.
    MeshChanges changes() noexcept;

private:
    [[nodiscard]] std::uint32_t distance(std::uint32_t wanted) const noexcept;
    [[nodiscard]] double rebuild_ns(std::uint32_t wanted) const noexcept;
    [[nodiscard]] double send_ns(std::uint32_t wanted) const noexcept;
    void walk(std::uint32_t wanted) noexcept;
    void step_down() noexcept;
    void step_up() noexcept;
    void rebuild(std::uint32_t wanted) noexcept;
    void rebuild_vertices(std::uint32_t wanted) noexcept;
    void rebuild_indices(std::uint32_t wanted) noexcept;
    void map_list(const MeshPatches::List& list, std::uint32_t wanted) noexcept;
    const MeshPatches::List& place_list(std::uint32_t patch, std::uint32_t list) noexcept;
    void show_next(std::uint32_t patch) noexcept;
    void show_previous(std::uint32_t patch) noexcept;

    const ProgressiveMesh* mesh_;
    const MeshKernels* kernels_;
    std::uint32_t level_;
    double cost_ns_ = 0.0;
    std::size_t next_change_;           // of the patches: those before it have levels below level_
    std::vector<std::uint32_t> shown_;  // list of each patch
    std::vector<MeshRange> draw_;
    HugeVector<PackedVertex> vertex_;
    HugeVector<std::uint32_t> index_;
    HugeVector<std::uint32_t> map_;     // of rebuild: where the vertices from the level on have gone
    std::vector<std::uint32_t> local_;  // the vertices of one list at a level
    ChangedBlocks vertex_changed_, index_changed_;
};

}  // namespace tact
