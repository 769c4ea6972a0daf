// The drawn cut through a progressive mesh: changes to any vertex count and reports the changes to upload.
//
// Buffers   vertex() and index() are whole blocks that never move; create GPU buffers of their sizes once,
//           then upload the changes and draw the ranges of draws(). Some of the triangles in these are
//           degenerate (0, 0, 0). Vertices from vertices() on are not used
// Repeats   the drawn mesh depends on the vertex count alone, bit for bit, independently of the path to it
// Time      whichever is cheapest in its cost model: single steps of 20 to 60 ns; a rebuild by the collapse map,
//           at most about 10 ns per vertex of the mesh; or a return to the original, which rewrites only what
//           changed since it was there, and steps from it. Never allocates
// Memory    20 bytes per vertex and 12 per triangle of the original: the buffers and a map
// Thread    a MeshCut belongs to one thread; the mesh may be shared and must outlive it
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
    std::span<const MeshRange> vertex, index;  // increasing and disjoint; in vertices, in indices
};

class MeshCut {
public:
    static constexpr std::uint32_t kVertexShift = 4, kIndexShift = 6;  // blocks of 16 vertices, 64 indices

    // Starts at the base. The first changes() are the whole buffers, which also hold the rest of the original.
    explicit MeshCut(const ProgressiveMesh& mesh);

    // Changes to `wanted` vertices, clamped to [vertices_min, vertices] of the mesh. Returns the new count.
    std::uint32_t set_vertices(std::uint32_t wanted) noexcept;
    // The same within a budget: at once if steps or a rebuild, including the upload, fit in the cost model;
    // otherwise as many steps as fit, at least kStepsMin. Repeat until `wanted` is reached.
    std::uint32_t approach(std::uint32_t wanted, double budget_ns) noexcept;
    static constexpr std::uint32_t kStepsMin = 256;
    // Cost of set_vertices() in the model, including the upload.
    [[nodiscard]] double whole_ns(std::uint32_t wanted) const noexcept;
    // Cost of the last of these calls in the model, including the upload.
    [[nodiscard]] double cost_ns() const { return cost_ns_; }

    [[nodiscard]] std::uint32_t vertices() const { return level_; }
    [[nodiscard]] std::uint32_t triangles() const { return mesh_->triangles(level_); }
    [[nodiscard]] float error_m() const { return mesh_->error_m(level_); }
    [[nodiscard]] std::span<const PackedVertex> vertex() const { return vertex_; }
    [[nodiscard]] std::span<const std::uint32_t> index() const { return index_; }
    // Parts of index() to draw, increasing; some may be empty.
    [[nodiscard]] std::span<const MeshRange> draws() const { return draw_; }

    // Differences since the last call of changes(); the spans are valid until the next one. Ranges are
    // whole blocks of 16 vertices or 64 indices (256 bytes), joined over gaps of up to 512 bytes.
    MeshChanges changes() noexcept;

private:
    [[nodiscard]] std::uint32_t distance(std::uint32_t wanted) const noexcept;
    [[nodiscard]] double rebuild_ns(std::uint32_t wanted) const noexcept;
    [[nodiscard]] double all_bytes(std::uint32_t wanted) const noexcept;
    void walk(std::uint32_t wanted) noexcept;
    void step_down() noexcept;
    void step_up() noexcept;
    // The cheapest way to a level, in the cost model without the upload.
    enum class Way : std::uint8_t { walk, rebuild, original };
    struct Plan {
        Way way;
        double make_ns, send_ns;
    };
    [[nodiscard]] Plan plan(std::uint32_t wanted) const noexcept;
    void restore_original() noexcept;
    void restore_vertices() noexcept;
    void restore_indices() noexcept;
    void restore_patch(std::uint32_t patch) noexcept;
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
    std::size_t next_change_;           // of the patches: earlier changes have levels below level_
    std::vector<std::uint32_t> shown_;  // list of each patch
    std::vector<MeshRange> draw_;
    HugeVector<PackedVertex> vertex_;
    HugeVector<std::uint32_t> index_;
    HugeVector<std::uint32_t> map_;     // for a rebuild: targets of the vertices from the level on
    std::vector<std::uint32_t> local_;  // vertices of one list at a level
    ChangedBlocks vertex_changed_, index_changed_;
};

}  // namespace tact
