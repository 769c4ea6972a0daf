// Two ways to move. Steps: contraction k writes its parent and about three corners; a split writes the same
// ones back and two triangles at their birth. Rebuild: the version of each vertex that the level shows is
// copied, the collapse map of the level is one pass over the vertices contracted since the lists were made
// (parents come first), and every patch looks the vertices of its list up in it.
//
// Measured 2026-11-22, a million vertices, medians of processor time in a quiet moment of a shared machine;
// while other programs keep its caches busy all of it takes 1.3 to 2 times as long.
//   100 % -> 28 %           3.7 ms, where a plain copy of the result takes 1.4
//   28 % -> 100 %           8.3 ms
//   1000 steps              0.022 ms down, 0.027 up, and 0.013 to find what they changed
//   memory of the mesh      170 bytes a vertex
// A step meets a dozen lines of memory at random, so it costs what those do. Where each corner lies is known
// when the mesh is made, as a level always shows the same lists: 31 -> 23 ns a step, 39 -> 30 up. Marks are
// bits and their runs are listed without branches: 30 -> 12 us after 1000 steps.
//
// Nothing is far from what the memory gives: 15 MB are written and 18 MB read for the 28 %. Vertices drawn
// are transformed 1.3 to 1.5 times; below 100 %, 44 % of degenerate triangles come on top. The lists of the
// next patch are fetched ahead; what that saves is within the noise here. Tried: the same for coming steps or
// vertices changed nothing, and so did writing vertices past the caches; versions listed per contraction
// instead of per vertex wrote to memory at random, 14 ms instead of 3 for the vertices alone; a branch for
// dead triangles when looking up 2.7 ms instead of 2.1.
#include "ipc/scene/mesh/mesh_cut.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "ipc/base/prefetch.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kVertexShift = 4, kVertexJoin = 2;
constexpr std::uint32_t kIndexShift = 6, kIndexJoin = 2;

constexpr std::uint32_t kListed = 1024;  // versions at a time

// ProgressiveMesh::Birth: corner of the child, of the parent, of the other vertex.
constexpr std::uint8_t kTurn[8][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};

// Nanoseconds, with nothing else on the core.
constexpr double kStepNs = 70.0;     // over a stretch not visited lately; 20 over a warm one
constexpr double kScanNs = 1.0;      // a version of the vertices of the level
constexpr double kCopyNs = 3.5;      // a vertex of the level
constexpr double kTriangleNs = 3.0;  // a triangle of the level, with its share of dead ones
// To send what changed: a step is two or three short ranges until they join; at most all of it goes.
constexpr double kSendStepNs = 350.0;
constexpr double kSendByteNs = 0.1;

// Returns whether that was a change, as any bit: bit for bit, as it is uploaded; there is no padding in it.
std::uint64_t replace(PackedVertex& old, const PackedVertex& now) {
    std::array<std::uint64_t, 2> a, b;
    std::memcpy(a.data(), &old, sizeof(a));
    std::memcpy(b.data(), &now, sizeof(b));
    std::memcpy(&old, b.data(), sizeof(b));
    return (a[0] ^ b[0]) | (a[1] ^ b[1]);
}

// The lists of a level lie apart from each other, so each begins with a wait unless somebody looks ahead.
void fetch_list(const MeshPatches& p, const MeshPatches::List& list) {
    const auto fetch = [](const auto* from, std::size_t count) {
        constexpr std::size_t kLine = 64 / sizeof(*from);
        for (std::size_t i = 0; i < count; i += kLine) prefetch(from + i);
    };
    fetch(p.vertex.data() + list.vertex_first, list.vertices);
    fetch(p.parent.data() + list.vertex_first, list.vertices);
    fetch(p.corner.data() + std::size_t{3} * list.first,
          std::min<std::size_t>(512, std::size_t{3} * list.triangles));
}

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
    rebuild(mesh.vertices_min());
    vertex_changed_.mark(0, level_);
}

double MeshCut::whole_ns(std::uint32_t wanted) const noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    return std::min(kStepNs * distance(wanted), rebuild_ns(wanted)) + send_ns(wanted);
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
    if (whole_ns(wanted) <= budget_ns) return set_vertices(wanted);
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
    const std::uint32_t first = mesh_->span_of(wanted).version_first;
    const std::uint32_t end = mesh_->coarsest_version(wanted - 1) + 1;
    return kScanNs * static_cast<double>(end - first) + kCopyNs * wanted +
           kTriangleNs * static_cast<double>(mesh_->triangles(wanted));
}

double MeshCut::send_ns(std::uint32_t wanted) const noexcept {
    const double all = static_cast<double>(sizeof(PackedVertex)) * wanted + 12.0 * mesh_->triangles(wanted);
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

void MeshCut::rebuild(std::uint32_t wanted) noexcept {
    rebuild_vertices(wanted);
    rebuild_indices(wanted);
    level_ = wanted;
}

// The versions that the level shows are one per vertex, in the order of the vertices. They are listed a few
// at a time, then copied; blocks are marked where they differ.
void MeshCut::rebuild_vertices(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t end = m.coarsest_version(wanted - 1) + 1;
    std::array<std::uint32_t, kListed + kListSlack> list;
    std::uint32_t v = 0;
    for (std::uint32_t at = m.span_of(wanted).version_first; at < end; at += kListed) {
        const std::uint32_t here = std::min(kListed, end - at);
        const std::uint32_t count =
            kernels_->list_versions(m.version_level_.data() + at, here, wanted, list.data());
        const PackedVertex* const version = m.version_.data() + at;
        for (std::uint32_t i = 0; i < count;) {
            const std::uint32_t block = std::min(count - i, (1U << kVertexShift) - v % (1U << kVertexShift));
            std::uint64_t differ = 0;
            for (const std::uint32_t stop = i + block; i < stop; ++i, ++v)
                differ |= replace(vertex_[v], version[list[i]]);
            if (differ != 0) vertex_changed_.mark(v - 1);
        }
    }
    if (wanted > level_) vertex_changed_.mark(level_, wanted);
}

void MeshCut::rebuild_indices(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    const MeshPatches& p = m.patches_;
    std::uint32_t mapped = wanted;
    for (std::uint32_t patch = 0; patch < shown_.size(); ++patch) {
        shown_[patch] = p.list_at(patch, wanted);
        mapped = std::max(mapped, p.list[shown_[patch]].level);
    }
    kernels_->follow(m.parent_.data() + (wanted - m.base_), wanted, mapped - wanted, map_.data());
    for (std::uint32_t patch = 0; patch < shown_.size(); ++patch) {
        const MeshPatches::List& list = place_list(patch, shown_[patch]);
        if (patch + 1 < shown_.size()) fetch_list(p, p.list[shown_[patch + 1]]);
        map_list(list, wanted);
        // Triangles that the level does not have get two equal corners.
        kernels_->look_up(p.corner.data() + std::size_t{3} * list.first, list.triangles, local_.data(),
                          index_.data() + draw_[patch].first, true);
    }
    next_change_ = static_cast<std::size_t>(
        std::lower_bound(p.change.begin(), p.change.end(), wanted,
                         [](const MeshPatches::Change& c, std::uint32_t level) { return c.level < level; }) -
        p.change.begin());
}

// Leaves the vertices of a list as the level has them in local_. Most parents are in the list too; only the
// others are looked for in the map of all, at random.
void MeshCut::map_list(const MeshPatches::List& list, std::uint32_t wanted) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const std::uint32_t* const vertex = p.vertex.data() + list.vertex_first;
    const std::uint16_t* const parent = p.parent.data() + list.vertex_first;
    const auto kept =
        static_cast<std::uint32_t>(std::lower_bound(vertex, vertex + list.vertices, wanted) - vertex);
    std::uint32_t* const to = local_.data();
    std::copy_n(vertex, kept, to);
    for (std::uint32_t i = kept; i < list.vertices; ++i)
        to[i] = parent[i] == MeshPatches::kElsewhere ? map_[vertex[i] - wanted] : to[parent[i]];
}

// Down to the next list, at its own level, where it has its vertices as they are and nothing is dead.
void MeshCut::show_next(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& list = place_list(patch, shown_[patch] + 1);
    kernels_->look_up(p.corner.data() + std::size_t{3} * list.first, list.triangles,
                      p.vertex.data() + list.vertex_first, index_.data() + draw_[patch].first, false);
}

// Up to the list before, at the level where this one ends: what lives is in this one, as it is.
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

// Everything about showing a list but its corners.
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
