// The rebuild of MeshCut; see mesh_cut.cpp.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "ipc/base/prefetch.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kListed = 1024;  // versions at a time

// Cache lines of the next patch that are prefetched for every kPortion triangles of this one: as many corners as
// are read, and all of its vertices for a patch of which a third is restored.
constexpr std::uint32_t kPortion = 256, kVertexLines = 32, kCornerLines = 24;

// Prefetches a table in portions.
class Ahead {
public:
    Ahead(const void* first, std::size_t bytes)
        : at_(static_cast<const std::byte*>(first)), end_(at_ + bytes) {}
    void fetch(std::size_t lines) {
        for (; lines > 0 && at_ < end_; --lines, at_ += 64) prefetch(at_);
    }

private:
    const std::byte *at_, *end_;
};

// A return to the original takes whole triangles: 64 of them fill three blocks of indices.
constexpr std::uint32_t kGroup = 64, kGroups = MeshPatches::kTriangles / kGroup;
static_assert(3 * kGroup == 3U << MeshCut::kIndexShift && kGroups == 64);

// Bit g: any of bits 3 g, 3 g + 1, 3 g + 2 of the three words.
std::uint64_t any_of_three(std::uint64_t w0, std::uint64_t w1, std::uint64_t w2) {
    const std::array<std::uint64_t, 3> word{w0, w1, w2};
    std::uint64_t groups = 0;
    for (std::uint32_t g = 0; g < kGroups; ++g) {
        std::uint64_t any = 0;
        for (std::uint32_t bit = 3 * g; bit < 3 * g + 3; ++bit) any |= word[bit / 64] >> bit % 64;
        groups |= (any & 1) << g;
    }
    return groups;
}

// Returns a non-zero value for a change: compares bit for bit, as uploaded; the struct has no padding.
std::uint64_t replace(PackedVertex& old, const PackedVertex& now) {
    std::array<std::uint64_t, 2> a, b;
    std::memcpy(a.data(), &old, sizeof(a));
    std::memcpy(b.data(), &now, sizeof(b));
    std::memcpy(&old, b.data(), sizeof(b));
    return (a[0] ^ b[0]) | (a[1] ^ b[1]);
}

// The lists of a level are scattered, so each would start with a cache miss without prefetching.
template <class T>
void fetch(const T* from, std::size_t count) {
    constexpr std::size_t kLine = 64 / sizeof(T);
    for (std::size_t i = 0; i < count; i += kLine) prefetch(from + i);
}
void fetch_list(const MeshPatches& p, const MeshPatches::List& list) {
    fetch(p.vertex.data() + list.vertex_first, list.vertices);
    fetch(p.corner.data() + std::size_t{3} * list.first,
          std::min<std::size_t>(512, std::size_t{3} * list.triangles));
}
void fetch_parents(const MeshPatches& p, const MeshPatches::List& list) {
    fetch(p.parent.data() + list.vertex_first, list.vertices);
}

}  // namespace

void MeshCut::rebuild(std::uint32_t wanted) noexcept {
    rebuild_vertices(wanted);
    rebuild_indices(wanted);
    level_ = wanted;
}

// The versions shown by a level are one per vertex, in the order of the vertices. They are listed in
// portions, then copied; differing blocks are marked.
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
        if (patch + 1 < shown_.size()) {
            fetch_list(p, p.list[shown_[patch + 1]]);
            fetch_parents(p, p.list[shown_[patch + 1]]);
        }
        map_list(list, wanted);
        // Triangles that do not exist at the level get two equal corners.
        kernels_->look_up(p.corner.data() + std::size_t{3} * list.first, list.triangles, local_.data(),
                          index_.data() + draw_[patch].first, true);
    }
    next_change_ = static_cast<std::size_t>(
        std::lower_bound(p.change.begin(), p.change.end(), wanted,
                         [](const MeshPatches::Change& c, std::uint32_t level) { return c.level < level; }) -
        p.change.begin());
}

// Blocks that nothing has written since the original was shown still hold it: those of vertices that the levels
// below did not use or move, and the ends of the patches, past their shorter lists.
void MeshCut::restore_original() noexcept {
    restore_vertices();
    restore_indices();
    level_ = mesh_->vertices();
    vertex_changed_.settle();
    index_changed_.settle();
}

void MeshCut::restore_vertices() noexcept {
    const ProgressiveMesh& m = *mesh_;
    constexpr std::uint32_t kBlock = 1U << kVertexShift;
    static_assert(ProgressiveMesh::kVersionStride == 64 * kBlock);
    std::array<std::uint32_t, kListed + kListSlack> list;
    for (std::size_t word = 0; word + 1 < m.version_original_.size(); ++word) {
        const std::uint64_t unsettled = vertex_changed_.unsettled(word);
        if (unsettled == 0) continue;
        vertex_changed_.mark_word(word, unsettled);
        auto v = static_cast<std::uint32_t>(word) * ProgressiveMesh::kVersionStride;
        const std::uint32_t end = m.version_original_[word + 1];
        for (std::uint32_t at = m.version_original_[word]; at < end; at += kListed) {
            const std::uint32_t count = kernels_->list_versions(
                m.version_level_.data() + at, std::min(kListed, end - at), mesh_->vertices(), list.data());
            const PackedVertex* const version = m.version_.data() + at;
            for (std::uint32_t i = 0; i < count;) {
                const std::uint32_t stop = std::min(count, i + kBlock - v % kBlock);
                if ((unsettled >> v / kBlock % 64 & 1) == 0) {
                    v += stop - i;
                    i = stop;
                }
                for (; i < stop; ++i, ++v) vertex_[v] = version[list[i]];
            }
        }
    }
}

void MeshCut::restore_indices() noexcept {
    for (std::uint32_t patch = 0; patch < shown_.size(); ++patch) restore_patch(patch);
    next_change_ = mesh_->patches_.change.size();
}

// All triangles of the first list exist in the original, with its vertices.
void MeshCut::restore_patch(std::uint32_t patch) noexcept {
    const MeshPatches& p = mesh_->patches_;
    const MeshPatches::List& list = p.list[p.list_first[patch]];
    const std::size_t first = std::size_t{3 * MeshPatches::kTriangles} * patch;
    shown_[patch] = p.list_first[patch];
    draw_[patch] = {static_cast<std::uint32_t>(first), 3U * list.triangles};
    const std::size_t word = std::size_t{3} * patch;
    std::uint64_t groups = any_of_three(index_changed_.unsettled(word), index_changed_.unsettled(word + 1),
                                        index_changed_.unsettled(word + 2));
    const bool more = patch + 1 < shown_.size();
    const MeshPatches::List& following = p.list[p.list_first[patch + (more ? 1 : 0)]];
    Ahead vertices(p.vertex.data() + following.vertex_first, more ? 4U * following.vertices : 0U),
        corners(p.corner.data() + std::size_t{3} * following.first, more ? 6U * following.triangles : 0U);
    for (std::uint32_t at = 0; groups != 0;) {  // runs of groups
        const auto gap = static_cast<std::uint32_t>(std::countr_zero(groups));
        groups >>= gap;
        const auto run = static_cast<std::uint32_t>(std::countr_one(groups));
        groups = run < 64 ? groups >> run : 0;
        const std::uint32_t from = kGroup * (at + gap);
        at += gap + run;
        const std::uint32_t end = std::min<std::uint32_t>(list.triangles, kGroup * at);
        if (from >= end) break;
        index_changed_.mark(first + 3 * from, first + 3 * end);
        for (std::uint32_t t = from; t < end; t += kPortion) {
            vertices.fetch(kVertexLines);
            corners.fetch(kCornerLines);
            kernels_->look_up(p.corner.data() + std::size_t{3} * (list.first + t),
                              std::min(kPortion, end - t), p.vertex.data() + list.vertex_first,
                              index_.data() + first + 3 * t, true);
        }
    }
}

// Writes the vertices of a list at the given level to local_. Most parents are in the list too; only the
// others need random access to the map of all vertices.
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

}  // namespace tact
