// Three ways to change the level. Steps: contraction k writes its parent and about three corners; a split
// writes the same ones back and two triangles at their birth. Rebuild: copies the version of each vertex
// that the level shows, computes the level's collapse map in one pass over the vertices contracted since
// the lists were made (parents come first), and every patch looks up the vertices of its list in it. Return to the
// original: rewrites the blocks that were written since the original was shown, and contracts from there. A coarse
// level overwrites only the vertices that it keeps and the beginning of each patch; the rest of both buffers
// still holds the original, and so does the viewer's copy.
//
// Return from 28 % to the original, measured 2026-11-29 on a million vertices (one shared core of 2.6 GHz, Zen 5; p50
// of single passes): 4.1 -> 1.5 ms, where a memcpy of both buffers takes 1.7 ms. 15 MB instead of 40 MB are written and
// uploaded. It reads as much, and waited for that memory: vertices and corners of the next patch are
// prefetched between portions of the current one, 3.1 -> 1.1 ms for the indices; all at once took 2.1 ms, as the
// core then waits for its line buffers. With cached lists it takes 0.75 ms, with ordinary stores 0.5 ms more.
//
// Measured 2026-11-22, a million vertices, medians of processor time in a quiet period of a shared machine;
// with other programs using its caches everything takes 1.3 to 2 times as long.
//   100 % -> 28 %           3.7 ms; a plain copy of the result takes 1.4 ms
//   28 % -> 100 %           8.3 ms
//   1000 steps              0.022 ms down, 0.027 ms up, and 0.013 ms to find the changes
//   memory of the mesh      170 bytes per vertex
// A step accesses a dozen cache lines at random, which dominates its cost. The place of each corner is
// computed when the mesh is built, as a level always shows the same lists: 31 -> 23 ns per step down, 39 ->
// 30 ns up. Marks are bits and their runs are listed without branches: 30 -> 12 us after 1000 steps.
//
// All parts are close to the memory bandwidth: for the 28 %, 15 MB are written and 18 MB read. Drawn
// vertices are transformed 1.3 to 1.5 times; below 100 %, 44 % of degenerate triangles are added. The lists
// of the next patch are prefetched; the gain is within the noise here. Also tested: prefetching for coming
// steps or vertices had no effect, nor had non-temporal stores of vertices; versions listed per contraction
// instead of per vertex wrote to memory at random, 14 ms instead of 3 ms for the vertices alone; a branch
// for dead triangles in the lookup took 2.7 ms instead of 2.1 ms.
#include "ipc/scene/mesh/mesh_cut.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "ipc/base/prefetch.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kVertexJoin = 2, kIndexJoin = 2;

// ProgressiveMesh::Birth: corner of the child, of the parent, of the other vertex.
constexpr std::uint8_t kTurn[8][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};

// Nanoseconds, on an otherwise idle core.
constexpr double kStepNs = 70.0;     // over vertices that are not cached; 20 over cached ones
constexpr double kScanNs = 1.0;      // per version of the vertices of the level
constexpr double kCopyNs = 3.5;      // per vertex of the level
constexpr double kTriangleNs = 3.0;  // per triangle of the level, with its fraction of dead ones
constexpr double kVertexBlockNs = 50.0, kIndexBlockNs = 60.0;  // per block that is restored
constexpr double kBlockBytes = 256.0;
// Cost of sending changes: a step is two or three short ranges until they join; at most the whole buffer is sent.
constexpr double kSendStepNs = 350.0;
constexpr double kSendByteNs = 0.1;

}  // namespace

MeshCut::MeshCut(const ProgressiveMesh& mesh)
    : mesh_(&mesh),
      kernels_(&fastest_mesh_kernels()),
      level_(mesh.vertices()),
      next_change_(mesh.patches_.change.size()),
      shown_(mesh.patches_.list_first.begin(), mesh.patches_.list_first.end() - 1),
      draw_(shown_.size()),
      vertex_(mesh.vertices()),
      index_(std::size_t{3} * mesh.triangles()),
      map_(mesh.vertices()),
      vertex_changed_(vertex_.size(), kVertexShift, kVertexJoin),
      index_changed_(index_.size(), kIndexShift, kIndexJoin) {
    std::uint32_t longest = 0;
    for (const MeshPatches::List& list : mesh.patches_.list)
        longest = std::max<std::uint32_t>(longest, list.vertices);
    local_.resize(longest);
    rebuild(level_);
    (void)changes();  // of the original, which is now the settled content
    rebuild(mesh.vertices_min());
    vertex_changed_.send_all();
    index_changed_.send_all();
}

double MeshCut::whole_ns(std::uint32_t wanted) const noexcept {
    const Plan best = plan(std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices()));
    return best.make_ns + best.send_ns;
}

std::uint32_t MeshCut::set_vertices(std::uint32_t wanted) noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    const Plan best = plan(wanted);
    cost_ns_ = best.make_ns + best.send_ns;
    switch (best.way) {
        case Way::rebuild:
            rebuild(wanted);
            break;
        case Way::original:
            restore_original();
            [[fallthrough]];
        case Way::walk:
            walk(wanted);
            break;
    }
    return level_;
}

MeshCut::Plan MeshCut::plan(std::uint32_t wanted) const noexcept {
    const double steps = distance(wanted), all_ns = kSendByteNs * all_bytes(wanted);
    const double walk_ns = kStepNs * steps, rebuild_all_ns = rebuild_ns(wanted);
    const Plan best = walk_ns > rebuild_all_ns
                          ? Plan{Way::rebuild, rebuild_all_ns, std::min(kSendStepNs * steps, all_ns)}
                          : Plan{Way::walk, walk_ns, std::min(kSendStepNs * steps, all_ns)};
    // Counting the blocks is not free, and only an end near the original can be worth it.
    const double down = mesh_->vertices() - wanted;
    if (kStepNs * down >= best.make_ns) return best;
    const auto vertex_blocks = static_cast<double>(vertex_changed_.unsettled_blocks());
    const auto index_blocks = static_cast<double>(index_changed_.unsettled_blocks());
    const Plan original{Way::original,
                        kVertexBlockNs * vertex_blocks + kIndexBlockNs * index_blocks + kStepNs * down,
                        std::min({best.send_ns, kSendStepNs * down + kSendByteNs * kBlockBytes *
                                                                         (vertex_blocks + index_blocks)})};
    return original.make_ns < best.make_ns ? original : best;
}

std::uint32_t MeshCut::approach(std::uint32_t wanted, double budget_ns) noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    const std::uint32_t way = distance(wanted);
    if (whole_ns(wanted) <= budget_ns) return set_vertices(wanted);
    // More steps than these may fit where their ranges join, but that is not certain.
    const double fit = budget_ns > 0.0 ? budget_ns / (kStepNs + kSendStepNs) : 0.0;
    const std::uint32_t steps =
        fit < way ? std::min(std::max(static_cast<std::uint32_t>(fit), kStepsMin), way) : way;
    cost_ns_ = (kStepNs + kSendStepNs) * steps;
    walk(wanted > level_ ? level_ + steps : level_ - steps);
    return level_;
}

std::uint32_t MeshCut::distance(std::uint32_t wanted) const noexcept {
    return wanted > level_ ? wanted - level_ : level_ - wanted;
}

double MeshCut::rebuild_ns(std::uint32_t wanted) const noexcept {
    const std::uint32_t first = mesh_->span_of(wanted).version_first;
    const std::uint32_t end = mesh_->coarsest_version(wanted - 1) + 1;
    return kScanNs * static_cast<double>(end - first) + kCopyNs * wanted +
           kTriangleNs * static_cast<double>(mesh_->triangles(wanted));
}

double MeshCut::all_bytes(std::uint32_t wanted) const noexcept {
    return static_cast<double>(sizeof(PackedVertex)) * wanted + 12.0 * mesh_->triangles(wanted);
}

// At the level of the original both buffers are shown completely, whatever was there before.
MeshChanges MeshCut::changes() noexcept {
    const MeshChanges changed{vertex_changed_.take(), index_changed_.take()};
    if (level_ == mesh_->vertices()) {
        vertex_changed_.settle();
        index_changed_.settle();
    }
    return changed;
}

void MeshCut::walk(std::uint32_t wanted) noexcept {
    while (level_ > wanted) step_down();
    while (level_ < wanted) step_up();
}

void MeshCut::step_down() noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t k = --level_ - m.base_, parent = m.parent_[k];
    vertex_[parent] = m.version_[m.version_merged_[k]];
    vertex_changed_.mark(parent);
    std::uint32_t* const index = index_.data();
    const std::uint32_t* const changes = m.change_.data();
    for (std::uint32_t i = m.change_first_[k], end = m.change_first_[k + 1]; i < end; ++i) {
        index[changes[i]] = parent;
        index_changed_.mark(changes[i]);
    }
    const ProgressiveMesh::Birth* const births = m.birth_.data() - m.triangle_count_[0];
    for (std::uint32_t t = m.triangle_count_[k], end = m.triangle_count_[k + 1]; t < end; ++t) {
        const std::uint32_t at = births[t].place;
        index[at] = index[at + 1] = index[at + 2] = 0;
        index_changed_.mark_triangle(at);
    }
    while (next_change_ > 0 && m.patches_.change[next_change_ - 1].level >= level_)
        show_next(m.patches_.change[--next_change_].patch);
}

void MeshCut::step_up() noexcept {
    const ProgressiveMesh& m = *mesh_;
    while (next_change_ < m.patches_.change.size() && m.patches_.change[next_change_].level <= level_)
        show_previous(m.patches_.change[next_change_++].patch);
    const std::uint32_t child = level_++, k = child - m.base_, parent = m.parent_[k];
    vertex_[parent] = m.version_[m.version_merged_[k] - 1];
    vertex_[child] = m.version_[m.coarsest_version(child)];
    vertex_changed_.mark(parent);
    vertex_changed_.mark(child);
    std::uint32_t* const index = index_.data();
    const std::uint32_t* const changes = m.change_.data();
    for (std::uint32_t i = m.change_first_[k], end = m.change_first_[k + 1]; i < end; ++i) {
        index[changes[i]] = child;
        index_changed_.mark(changes[i]);
    }
    const ProgressiveMesh::Birth* const births = m.birth_.data() - m.triangle_count_[0];
    for (std::uint32_t t = m.triangle_count_[k], end = m.triangle_count_[k + 1]; t < end; ++t) {
        const std::uint32_t at = births[t].place;
        const auto& turn = kTurn[births[t].other_and_turn >> 29];
        index[at + turn[0]] = child;
        index[at + turn[1]] = parent;
        index[at + turn[2]] = births[t].other_and_turn & ((1U << 29) - 1);
        index_changed_.mark_triangle(at);
    }
}

// Down to the next list, at its own level, where its vertices are unchanged and no triangle is dead.
void MeshCut::show_next(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& list = place_list(patch, shown_[patch] + 1);
    kernels_->look_up(p.corner.data() + std::size_t{3} * list.first, list.triangles,
                      p.vertex.data() + list.vertex_first, index_.data() + draw_[patch].first, false);
}

// Up to the previous list, at the level where this one ends: this one contains all live triangles unchanged.
void MeshCut::show_previous(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& now = p.list[shown_[patch]];
    const std::uint16_t* const from_slot = p.slot.data() + now.first;
    const std::uint16_t* const to_slot = p.slot.data() + place_list(patch, shown_[patch] - 1).first;
    std::uint32_t* const to = index_.data() + draw_[patch].first;
    const std::uint32_t* const vertex = p.vertex.data() + now.vertex_first;
    const std::uint16_t* const corner = p.corner.data() + std::size_t{3} * now.first;
    std::fill_n(to, draw_[patch].count, 0U);
    for (std::uint32_t t = 0; t < now.triangles; ++t) {
        const std::uint16_t* const from = corner + 3 * std::size_t{from_slot[t]};
        std::uint32_t* const at = to + 3 * std::size_t{to_slot[t]};
        for (int i = 0; i < 3; ++i) at[i] = vertex[from[i]];
    }
}

// Shows a list, except for its corners.
const MeshPatches::List& MeshCut::place_list(std::uint32_t patch, std::uint32_t list) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& l = p.list[list];
    const std::size_t first = std::size_t{3 * MeshPatches::kTriangles} * patch;
    shown_[patch] = list;
    draw_[patch] = {static_cast<std::uint32_t>(first), 3U * l.triangles};
    index_changed_.mark(first, first + draw_[patch].count);
    return l;
}

}  // namespace tact
