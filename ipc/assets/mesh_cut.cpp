// Two ways to move. Steps: contraction k writes its parent and about three corners; a split writes the same
// ones back and two triangles at their birth. Rebuild: the version of each vertex that the level shows is
// copied, the collapse map of the level is one pass over the contracted vertices (parents come first), and
// every patch looks the vertices of its list up in it.
//
// Measured 2026-11-21, a million vertices, one core with the other kept free, medians; in brackets what this
// replaced, in the same minutes: one list of triangles sorted by their death, each level a prefix of it.
//   100 % -> 28 %           6.4 ms (11.8), where a plain copy of the result takes 0.9
//   28 % -> 100 %           11.9 ms (27), where a plain copy takes 4.4
//   1000 steps              0.026 ms down, 0.028 up (0.012, 0.017); over new stretches 0.11 (0.11, 0.03)
//   vertices transformed    1.3 to 1.5 per vertex drawn; below 100 %, 44 % of degenerate triangles on top
//   memory of the mesh      147 bytes a vertex (163)
//
// The machine was one where reading memory at random is slow: what this replaced had taken 5.5 ms on another.
// Tried: fetching the memory of coming steps ahead changed nothing; versions listed per contraction instead
// of per vertex wrote to memory at random, 14 ms instead of 3 for the vertices alone; a branch for dead
// triangles when looking up 2.7 ms instead of 2.1; marks as bits 0.030 ms instead of 0.022 per 1000 steps.
#include "ipc/assets/mesh_cut.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace tact {
namespace {

constexpr std::uint32_t kVertexShift = 3, kVertexJoin = 3;
constexpr std::uint32_t kIndexShift = 5, kIndexJoin = 4;

constexpr std::uint32_t kFetchAhead = 24;  // versions

// ProgressiveMesh::Birth: corner of the child, of the parent, of the other vertex.
constexpr std::uint8_t kTurn[8][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};

// Nanoseconds, with nothing else on the core.
constexpr double kStepNs = 70.0;     // over a stretch not visited lately; 20 over a warm one
constexpr double kScanNs = 1.3;      // a version of the vertices of the level
constexpr double kCopyNs = 5.0;      // a vertex of the level
constexpr double kTriangleNs = 4.0;  // a triangle of the level, with its share of dead ones
// To send what changed: a step is two or three short ranges until they join; at most all of it goes.
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
      slot_(mesh.triangles()),
      scratch_(mesh.vertices() + kListSlack),
      vertex_changed_(vertex_.size(), kVertexShift, kVertexJoin),
      index_changed_(index_.size(), kIndexShift, kIndexJoin) {
    std::uint32_t longest = 0;
    for (const MeshPatches::List& list : mesh.patches_.list)
        longest = std::max<std::uint32_t>(longest, list.vertices);
    local_.resize(longest);
    rebuild(mesh.vertices_min());
    vertex_changed_.mark(0, level_);
}

std::uint32_t MeshCut::set_vertices(std::uint32_t wanted) noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    const double walk_ns = kStepNs * distance(wanted), jump_ns = rebuild_ns(wanted);
    cost_ns_ = std::min(walk_ns, jump_ns) + send_ns(wanted);
    if (walk_ns > jump_ns)
        rebuild(wanted);
    else
        walk(wanted);
    return level_;
}

std::uint32_t MeshCut::approach(std::uint32_t wanted, double budget_ns) noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    const std::uint32_t way = distance(wanted);
    if (std::min(kStepNs * way, rebuild_ns(wanted)) + send_ns(wanted) <= budget_ns)
        return set_vertices(wanted);
    // More steps than these may fit where their ranges join, but not surely.
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
    return kScanNs * static_cast<double>(mesh_->version_first_[wanted]) + kCopyNs * wanted +
           kTriangleNs * static_cast<double>(mesh_->triangles(wanted));
}

double MeshCut::send_ns(std::uint32_t wanted) const noexcept {
    const double all = static_cast<double>(sizeof(MeshVertex)) * wanted + 12.0 * mesh_->triangles(wanted);
    return std::min(kSendStepNs * distance(wanted), kSendByteNs * all);
}

MeshChanges MeshCut::changes() noexcept { return {vertex_changed_.take(), index_changed_.take()}; }

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
        const std::size_t at = place(changes[i] >> 2) + (changes[i] & 3U);
        index[at] = parent;
        index_changed_.mark(at);
    }
    const ProgressiveMesh::Birth* const births = m.birth_.data() - m.triangle_count_[0];
    for (std::uint32_t t = m.triangle_count_[k], end = m.triangle_count_[k + 1]; t < end; ++t) {
        const std::size_t at = place(births[t].number);
        index[at] = index[at + 1] = index[at + 2] = 0;
        index_changed_.mark(at);
        index_changed_.mark(at + 2);
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
    vertex_[child] = m.version_[m.version_first_[child + 1] - 1];
    vertex_changed_.mark(parent);
    vertex_changed_.mark(child);
    std::uint32_t* const index = index_.data();
    const std::uint32_t* const changes = m.change_.data();
    for (std::uint32_t i = m.change_first_[k], end = m.change_first_[k + 1]; i < end; ++i) {
        const std::size_t at = place(changes[i] >> 2) + (changes[i] & 3U);
        index[at] = child;
        index_changed_.mark(at);
    }
    const ProgressiveMesh::Birth* const births = m.birth_.data() - m.triangle_count_[0];
    for (std::uint32_t t = m.triangle_count_[k], end = m.triangle_count_[k + 1]; t < end; ++t) {
        const std::size_t at = place(births[t].number);
        const auto& turn = kTurn[births[t].other_and_turn >> 29];
        index[at + turn[0]] = child;
        index[at + turn[1]] = parent;
        index[at + turn[2]] = births[t].other_and_turn & ((1U << 29) - 1);
        index_changed_.mark(at);
        index_changed_.mark(at + 2);
    }
}

void MeshCut::rebuild(std::uint32_t wanted) noexcept {
    rebuild_vertices(wanted);
    rebuild_indices(wanted);
    level_ = wanted;
}

// The versions that the level shows are one per vertex, in the order of the vertices. They are listed first,
// then copied where they differ.
void MeshCut::rebuild_vertices(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    std::uint32_t* const list = scratch_.data();
    kernels_->list_versions(m.version_level_.data(), m.version_first_[wanted], wanted, list);
    const std::uint32_t old = std::min(level_, wanted);
    for (std::uint32_t v = 0; v < old; ++v) {
        __builtin_prefetch(&m.version_[list[std::min(v + kFetchAhead, wanted - 1)]]);
        const MeshVertex& now = m.version_[list[v]];
        // Bit for bit, as it is uploaded; there is no padding in it.
        if (std::memcmp(&vertex_[v], &now, sizeof(now)) == 0) continue;  // NOLINT(bugprone-*,cert-*)
        vertex_[v] = now;
        vertex_changed_.mark(v);
    }
    for (std::uint32_t v = old; v < wanted; ++v) {
        __builtin_prefetch(&m.version_[list[std::min(v + kFetchAhead, wanted - 1)]]);
        vertex_[v] = m.version_[list[v]];
    }
    vertex_changed_.mark(old, wanted);
}

void MeshCut::rebuild_indices(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    const MeshPatches& p = m.patches_;
    const std::uint32_t base = m.base_;
    std::uint32_t mapped = wanted;
    for (std::uint32_t patch = 0; patch < shown_.size(); ++patch) {
        std::uint32_t list = p.list_first[patch];
        while (list + 1 < p.list_first[patch + 1] && p.list[list + 1].level >= wanted) ++list;
        shown_[patch] = list;
        mapped = std::max(mapped, p.list[list].level);
    }
    std::uint32_t* const map = scratch_.data();
    std::iota(map, map + wanted, 0U);
    for (std::uint32_t v = wanted; v < mapped; ++v) map[v] = map[m.parent_[v - base]];
    for (std::uint32_t patch = 0; patch < shown_.size(); ++patch) {
        const MeshPatches::List& list = p.list[shown_[patch]];
        const std::uint32_t* const from = p.vertex.data() + list.vertex_first;
        for (std::uint32_t i = 0; i < list.vertices; ++i) local_[i] = map[from[i]];
        show_list(patch, shown_[patch], local_.data());
    }
    next_change_ = static_cast<std::size_t>(
        std::lower_bound(p.change.begin(), p.change.end(), wanted,
                         [](const MeshPatches::Change& c, std::uint32_t level) { return c.level < level; }) -
        p.change.begin());
}

// Down to the next list, at its own level, where it has its vertices as they are and nothing is dead.
void MeshCut::show_next(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const std::uint32_t list = place_list(patch, shown_[patch] + 1);
    const std::uint32_t* const vertex = p.vertex.data() + p.list[list].vertex_first;
    const std::uint16_t* const corner = p.corner.data() + std::size_t{3} * p.list[list].corner_first;
    kernels_->look_up(corner, p.list[list].triangles, vertex, index_.data() + draw_[patch].first);
}

// Up to the list before, at the level where this one ends: what lives is in this one, as it is.
void MeshCut::show_previous(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& now = p.list[shown_[patch]];
    place_list(patch, shown_[patch] - 1);
    std::uint32_t* const to = index_.data() + draw_[patch].first;
    const std::uint16_t* const slot = slot_.data() + (std::size_t{patch} << MeshPatches::kShift);
    const std::uint32_t* const vertex = p.vertex.data() + now.vertex_first;
    const std::uint16_t* corner = p.corner.data() + std::size_t{3} * now.corner_first;
    const std::uint16_t* const id = p.id.data() + now.id_first;
    std::fill_n(to, draw_[patch].count, 0U);
    for (std::uint32_t s = 0; s < now.triangles; ++s, corner += 3) {
        std::uint32_t* const at = to + 3 * std::size_t{slot[id[s]]};
        for (int i = 0; i < 3; ++i) at[i] = vertex[corner[i]];
    }
}

// `vertex`: those of the list at the level to be shown; triangles that it does not have get two equal ones.
void MeshCut::show_list(std::uint32_t patch, std::uint32_t list, const std::uint32_t* vertex) noexcept {
    const MeshPatches& p = mesh_->patches_;
    place_list(patch, list);
    kernels_->look_up(p.corner.data() + std::size_t{3} * p.list[list].corner_first, p.list[list].triangles,
                      vertex, index_.data() + draw_[patch].first);
}

// Everything about showing a list but its corners.
std::uint32_t MeshCut::place_list(std::uint32_t patch, std::uint32_t list) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& l = p.list[list];
    const std::size_t first = std::size_t{patch} << MeshPatches::kShift;
    std::uint16_t* const slot = slot_.data() + first;
    if (list == p.list_first[patch]) {
        std::iota(slot, slot + l.triangles, std::uint16_t{0});
    } else {
        const std::uint16_t* const id = p.id.data() + l.id_first;
        for (std::uint32_t s = 0; s < l.triangles; ++s) slot[id[s]] = static_cast<std::uint16_t>(s);
    }
    shown_[patch] = list;
    draw_[patch] = {static_cast<std::uint32_t>(3 * first), 3U * l.triangles};
    index_changed_.mark(3 * first, 3 * first + draw_[patch].count);
    return list;
}

}  // namespace tact
