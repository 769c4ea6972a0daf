// The view-dependence forest of a surface: the merges of the mesh's simplification, so that any part of it
// can be fine and the rest coarse (El-Sana, Varshney 1999).
//
// Leaves    are the vertices of the full mesh, numbered so that those below any node are a range. A node of
//           the forest replaces its two children; trees and nodes are in preorder: the node, its first
//           child, then its second. So children need no index: with L = middle - first leaves below the
//           first child, that is leaf `first` (L = 1) or the next node, and the second is leaf `middle` or
//           the node L places later
// Cut       any set of nodes and leaves that covers every leaf once. A triangle is active if its three
//           corners are below three different ones. It appears with one known split: that of the lowest
//           node whose two children separate two of its corners (the PAT of El-Sana, Varshney)
// Number    1, 2, … in the order of the merges; 0 for leaves. A node may be split if no adjacent vertex has
//           a higher number; two may merge if no adjacent vertex's parent has a lower number than theirs.
//           With these rules every merge finds the adjacent vertices of its construction, and the fold-over
//           prevention of the builder remains valid
// Needs     the same rule as explicit lists: the nodes that must be split before a node is, in addition to
//           its parent and to the needs of these. Each has a higher number, so there are no cycles. A node
//           may merge if no split node needs it. So the permitted changes are known without visiting
//           triangles
// Reach     of a node: Chebyshev distance max(|dx|,|dy|,|dz|) from it that contains all triangles at its
//           leaves, as in the full mesh
// Span      the same for the corners of all triangles that appear with the node or below, in any cut in
//           which they are active; own span: of those that appear with the node
// Deviation of a node; 0 for a leaf; never less than a child's. No point of an active triangle is farther
// from the full surface than the largest deviation of its three corners, and no point of a full triangle is
// farther from the active surface than the largest deviation of the nodes above its corners
// Section   FRST; read as views of the mapped file, without a copy: 64 bytes per node, one cache line, a
//           few times 4 bytes for needs, and 16 per triangle: about 52 bytes per triangle of a closed mesh.
//           Corners are stored again here, in the order in which splits need them
//
// Frame     model, metres
// Thread    immutable. The mesh and the section outlive it
// Errors    StartupError: order, ranges, numbers, needs and the place of every triangle are checked here,
//           so that later access needs no check
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct ForestNode {
    std::array<float, 3> position_m;
    float error_m;  // switch value: rms distance to the planes merged here, increasing to the root
    float deviation_m, reach_m, span_m, own_span_m;
    std::uint32_t first, middle, end;  // leaves: first child from first, second from middle
    std::uint32_t parent;              // a node, or kNoForestNode
    std::uint32_t number;              // of its merge, from 1
    std::uint32_t first_triangle;      // first of the triangles of its split; up to the next node's first
    std::uint32_t first_need;          // same scheme
    std::uint32_t reserved;            // zero

    [[nodiscard]] bool first_is_leaf() const { return middle - first == 1; }
    [[nodiscard]] bool second_is_leaf() const { return end - middle == 1; }
    // Its second child, if that is a node; the first one is the next node.
    [[nodiscard]] std::uint32_t second_of(std::uint32_t self) const { return self + (middle - first); }
};
static_assert(sizeof(ForestNode) == 64);

struct ForestTriangle {
    std::uint32_t number;               // in the full mesh
    std::array<std::uint32_t, 3> leaf;  // its corners in the full mesh
};
static_assert(sizeof(ForestTriangle) == 16);

inline constexpr std::uint32_t kNoForestNode = UINT32_MAX;

// Output of tact-prep, and content of the section.
struct VertexForestData {
    std::uint32_t leaves = 0;
    std::vector<std::uint32_t> root_first;  // one per tree: its first leaf; the last entry is `leaves`
    std::vector<ForestNode> node;
    std::vector<std::uint32_t> need;       // needed nodes, grouped by the node that needs them
    std::vector<ForestTriangle> triangle;  // by node, then those that always exist
};

class VertexForest {
public:
    // position_m: 3 per leaf; corner: 3 per triangle, used for comparison only. `where` is file and section.
    VertexForest(std::span<const std::uint32_t> root_first, std::span<const ForestNode> node,
                 std::span<const std::uint32_t> need, std::span<const ForestTriangle> triangle,
                 std::span<const float> position_m, std::span<const std::uint32_t> corner,
                 const std::string& where);

    [[nodiscard]] std::uint32_t leaves() const { return root_first_.back(); }
    [[nodiscard]] std::uint32_t nodes() const { return static_cast<std::uint32_t>(node_.size()); }
    [[nodiscard]] std::uint32_t triangles() const { return static_cast<std::uint32_t>(triangle_.size()); }
    [[nodiscard]] std::uint32_t roots() const { return static_cast<std::uint32_t>(root_first_.size() - 1); }
    [[nodiscard]] const ForestNode& node(std::uint32_t i) const { return node_[i]; }
    [[nodiscard]] std::array<float, 3> leaf_position_m(std::uint32_t v) const {
        return {position_m_[3 * std::size_t{v}], position_m_[3 * std::size_t{v} + 1],
                position_m_[3 * std::size_t{v} + 2]};
    }

    // A place in the forest: the leaves below it, and its node if there is more than one leaf.
    struct Branch {
        std::uint32_t first, end, node;  // node: kNoForestNode for a leaf, which is `first`
        [[nodiscard]] bool is_leaf() const { return node == kNoForestNode; }
    };
    [[nodiscard]] Branch root(std::uint32_t r) const {
        return branch(root_first_[r], root_first_[r + 1], root_first_[r] - r);
    }
    // which: 0 or 1; b must not be a leaf.
    [[nodiscard]] Branch child(const Branch& b, unsigned which) const {
        const std::uint32_t middle = node_[b.node].middle;
        return which == 0 ? branch(b.first, middle, b.node + 1)
                          : branch(middle, b.end, b.node + (middle - b.first));
    }
    [[nodiscard]] std::uint32_t tree_of(std::uint32_t leaf) const;
    [[nodiscard]] std::span<const ForestTriangle> triangles_of(std::uint32_t node) const {
        const std::uint32_t first = node_[node].first_triangle;
        return triangle_.subspan(first,
                                 (node + 1 < nodes() ? node_[node + 1].first_triangle : always_) - first);
    }
    [[nodiscard]] std::span<const std::uint32_t> needs_of(std::uint32_t node) const {
        const std::uint32_t first = node_[node].first_need;
        return need_.subspan(first, (node + 1 < nodes() ? node_[node + 1].first_need : need_.size()) - first);
    }
    // For prefetching before a split.
    [[nodiscard]] const std::uint32_t* first_need_of(std::uint32_t node) const {
        return need_.data() + node_[node].first_need;
    }
    [[nodiscard]] std::span<const ForestTriangle> triangles_always() const {
        return triangle_.subspan(always_);
    }

private:
    static Branch branch(std::uint32_t first, std::uint32_t end, std::uint32_t node) {
        return {first, end, end - first == 1 ? kNoForestNode : node};
    }
    void check(std::span<const std::uint32_t> corner, const std::string& where);
    std::span<const std::uint32_t> root_first_;
    std::span<const ForestNode> node_;
    std::span<const std::uint32_t> need_;
    std::span<const ForestTriangle> triangle_;
    std::span<const float> position_m_;
    std::uint32_t always_ = 0;  // start of the permanent triangles in triangle_
};

// On data in memory, which must outlive it.
VertexForest view_forest(const VertexForestData& data, std::span<const float> position_m,
                         std::span<const std::uint32_t> corner);

void write_forest(SceneWriter& out, const VertexForestData& data);
VertexForest read_forest(const SceneFile& file, std::span<const float> position_m,
                         std::span<const std::uint32_t> corner);

}  // namespace tact
