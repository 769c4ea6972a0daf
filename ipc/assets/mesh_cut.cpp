// Two ways to move. Steps: contraction i writes its parent and about three corners; a split writes the same
// ones back and two triangles at their birth. Rebuild: the collapse map of level n is one pass over the
// contracted vertices (parents come first), then every corner of the level is looked up in it.
#include "ipc/assets/mesh_cut.hpp"

#include <algorithm>
#include <cstring>

namespace tact {
namespace {

constexpr std::uint32_t kVertexBlockShift = 8;
constexpr std::uint32_t kIndexBlockShift = 10;

// Nanoseconds, for the choice between the two ways; of 2026-11-20 at a million vertices.
// Steps over a stretch not visited lately; over a warm one they take 10 and 14.
constexpr double kStepDownNs = 25.0;
constexpr double kStepUpNs = 70.0;
constexpr double kVertexNs = 3.0;
constexpr double kMapNs = 1.5;
constexpr double kCornerNs = 1.5;

void mark(std::vector<std::uint8_t>& dirty, std::uint32_t shift, std::size_t first,
          std::size_t end) noexcept {
    if (first >= end) return;
    const std::size_t a = first >> shift, b = (end - 1) >> shift;
    std::memset(dirty.data() + a, 1, b - a + 1);
}

// Collects and clears; what lies beyond `count` is not part of the level and will be marked when it is again.
std::size_t collect(std::vector<std::uint8_t>& dirty, std::uint32_t shift, std::size_t count,
                    std::vector<MeshRange>& out) noexcept {
    const std::size_t blocks = (count + (std::size_t{1} << shift) - 1) >> shift;
    std::size_t ranges = 0;
    for (std::size_t block = 0; block < blocks;) {
        const void* hit = std::memchr(dirty.data() + block, 1, blocks - block);
        if (hit == nullptr) break;
        const std::size_t a = static_cast<std::size_t>(static_cast<const std::uint8_t*>(hit) - dirty.data());
        std::size_t b = a;
        while (b < blocks && dirty[b] != 0) ++b;
        const std::size_t first = a << shift;
        const std::size_t end = std::min(count, b << shift);
        out[ranges++] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first)};
        block = b;
    }
    std::fill(dirty.begin(), dirty.end(), std::uint8_t{0});
    return ranges;
}

std::size_t block_count(std::size_t items, std::uint32_t shift) { return (items >> shift) + 1; }

}  // namespace

MeshCut::MeshCut(const ProgressiveMesh& mesh)
    : mesh_(&mesh),
      level_(mesh.vertices()),
      vertex_(mesh.data_.vertex.begin(), mesh.data_.vertex.end()),
      index_(mesh.data_.triangle.begin(), mesh.data_.triangle.end()),
      scratch_(mesh.vertices()),
      vertex_dirty_(block_count(vertex_.size(), kVertexBlockShift), 1),
      index_dirty_(block_count(index_.size(), kIndexBlockShift), 1),
      vertex_range_(vertex_dirty_.size() / 2 + 1),
      index_range_(index_dirty_.size() / 2 + 1) {
    rebuild(mesh.vertices_min());
}

std::uint32_t MeshCut::set_vertices(std::uint32_t wanted) noexcept {
    wanted = std::clamp(wanted, mesh_->vertices_min(), mesh_->vertices());
    const double steps = wanted > level_ ? wanted - level_ : level_ - wanted;
    const double mapped = wanted > level_ ? mesh_->vertices() : level_;
    const double rebuild_ns =
        kVertexNs * steps + kMapNs * mapped + kCornerNs * 3.0 * static_cast<double>(mesh_->triangles(wanted));
    if (steps * (wanted > level_ ? kStepUpNs : kStepDownNs) > rebuild_ns) {
        rebuild(wanted);
    } else {
        while (level_ > wanted) step_down();
        while (level_ < wanted) step_up();
    }
    return level_;
}

MeshChanges MeshCut::changes() noexcept {
    const std::size_t v = collect(vertex_dirty_, kVertexBlockShift, vertex().size(), vertex_range_);
    const std::size_t i = collect(index_dirty_, kIndexBlockShift, index().size(), index_range_);
    return {{vertex_range_.data(), v}, {index_range_.data(), i}};
}

void MeshCut::step_down() noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t k = level_ - 1 - m.data_.base_vertices;
    const std::uint32_t parent = m.data_.parent[k];
    vertex_[parent] = m.data_.merged[k];
    vertex_dirty_[parent >> kVertexBlockShift] = 1;
    for (std::uint32_t c = m.change_first_[k]; c < m.change_first_[k + 1]; ++c) {
        index_[m.change_[c]] = parent;
        index_dirty_[m.change_[c] >> kIndexBlockShift] = 1;
    }
    --level_;
}

void MeshCut::step_up() noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t k = level_ - m.data_.base_vertices;
    const std::uint32_t parent = m.data_.parent[k];
    vertex_[parent] = m.before_[k];
    vertex_[level_] = m.child_[k];
    vertex_dirty_[parent >> kVertexBlockShift] = 1;
    vertex_dirty_[level_ >> kVertexBlockShift] = 1;
    for (std::uint32_t c = m.change_first_[k]; c < m.change_first_[k + 1]; ++c) {
        index_[m.change_[c]] = level_;
        index_dirty_[m.change_[c] >> kIndexBlockShift] = 1;
    }
    const std::size_t first = std::size_t{3} * m.data_.triangle_count[k];
    const std::size_t end = std::size_t{3} * m.data_.triangle_count[k + 1];
    for (std::size_t c = first; c < end; ++c) index_[c] = m.birth_[c];
    mark(index_dirty_, kIndexBlockShift, first, end);
    ++level_;
}

void MeshCut::rebuild(std::uint32_t wanted) noexcept {
    rebuild_vertices(wanted);
    rebuild_index(wanted);
    level_ = wanted;
    mark(vertex_dirty_, kVertexBlockShift, 0, wanted);
    mark(index_dirty_, kIndexBlockShift, 0, index().size());
}

// Of all contractions between the two levels only the last one into a vertex counts. They are listed first,
// without a branch that would be mispredicted, then copied; both passes read memory in order.
void MeshCut::rebuild_vertices(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t base = m.data_.base_vertices;
    std::uint32_t* const list = scratch_.data();
    std::uint32_t count = 0;
    if (wanted < level_) {
        for (std::uint32_t k = wanted - base; k < level_ - base; ++k) {
            list[count] = k;
            count += m.coarser_[k] < wanted ? 1U : 0U;
        }
        for (std::uint32_t i = 0; i < count; ++i) vertex_[m.data_.parent[list[i]]] = m.data_.merged[list[i]];
    } else {
        std::copy(m.child_.begin() + (level_ - base), m.child_.begin() + (wanted - base),
                  vertex_.begin() + level_);
        for (std::uint32_t k = level_ - base; k < wanted - base; ++k) {
            list[count] = k;
            count += m.finer_[k] >= wanted ? 1U : 0U;
        }
        for (std::uint32_t i = 0; i < count; ++i) vertex_[m.data_.parent[list[i]]] = m.before_[list[i]];
    }
}

void MeshCut::rebuild_index(std::uint32_t wanted) noexcept {
    const ProgressiveMesh& m = *mesh_;
    const std::uint32_t base = m.data_.base_vertices;
    std::uint32_t* const map = scratch_.data();
    // Downward the present corners are mapped where they are, upward the original ones.
    const bool down = wanted < level_;
    const std::uint32_t highest = down ? level_ : m.vertices();
    for (std::uint32_t v = 0; v < wanted; ++v) map[v] = v;
    for (std::uint32_t v = wanted; v < highest; ++v) map[v] = map[m.data_.parent[v - base]];
    const std::uint32_t* const from = down ? index_.data() : m.data_.triangle.data();
    const std::size_t corners = std::size_t{3} * m.triangles(wanted);
    for (std::size_t c = 0; c < corners; ++c) index_[c] = map[from[c]];
}

}  // namespace tact
