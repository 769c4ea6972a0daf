#include "rt/force/surface/near_surface.hpp"

#include <bit>
#include <limits>

namespace tact {
namespace {

constexpr SurfaceNode kEmpty = [] {
    SurfaceNode node{};
    for (auto& low : node.low_m) low.fill(std::numeric_limits<float>::infinity());
    for (auto& high : node.high_m) high.fill(-std::numeric_limits<float>::infinity());
    node.child.fill(SurfaceNode::kNone);
    return node;
}();

struct Child {
    const SurfaceNode* parent;
    std::size_t k;
    [[nodiscard]] std::uint32_t code() const noexcept { return parent->child[k]; }
    [[nodiscard]] bool is_leaf() const noexcept { return (code() & SurfaceNode::kLeaf) != 0; }
};

void put(SurfaceNode& node, std::size_t k, const Child& from, std::uint32_t code) noexcept {
    node.child[k] = code;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low_m[axis][k] = from.parent->low_m[axis][from.k];
        node.high_m[axis][k] = from.parent->high_m[axis][from.k];
    }
}

}  // namespace

struct NearSurface::Builder {
    std::span<const SurfaceNode> from;
    std::array<float, 3> low_m, high_m;
    std::span<SurfaceNode> to;
    std::uint32_t made = 0;
    bool room = true;

    // One bit per child that overlaps the box.
    [[nodiscard]] unsigned reaching(const SurfaceNode& node) const noexcept {
        unsigned mask = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            unsigned in = 1;  // missing children have an empty box
            for (std::size_t axis = 0; axis < 3; ++axis)
                in &= static_cast<unsigned>(node.low_m[axis][k] <= high_m[axis]) &
                      static_cast<unsigned>(node.high_m[axis][k] >= low_m[axis]);
            mask |= in << k;
        }
        return mask;
    }
    // Skips nodes with a single child in the box.
    [[nodiscard]] Child reduced(Child child) const noexcept {
        while (!child.is_leaf()) {
            const unsigned mask = reaching(from[child.code()]);
            if (mask == 0 || (mask & (mask - 1)) != 0) break;
            child = {&from[child.code()], static_cast<std::size_t>(std::countr_zero(mask))};
        }
        return child;
    }
    // Copies depth first, as in the full tree. Needs room for one node.
    std::uint32_t copy(const SurfaceNode& node) noexcept {
        const std::uint32_t place = made++;
        SurfaceNode copied = kEmpty;
        const unsigned mask = reaching(node);
        for (std::size_t k = 0; k < 4; ++k) {
            if ((mask >> k & 1U) == 0) continue;
            const Child child = reduced({&node, k});
            if (child.is_leaf()) {
                put(copied, k, child, child.code());
            } else if (made < to.size()) {
                put(copied, k, child, copy(from[child.code()]));
            } else {
                room = false;
            }
        }
        to[place] = copied;
        return place;
    }
};

bool NearSurface::build(const SurfaceMesh& full, const std::array<float, 3>& low_m,
                        const std::array<float, 3>& high_m, std::uint64_t version) noexcept {
    Builder builder{full.tree(), low_m, high_m, node_};
    nodes_ = 0;
    version_ = version;
    if (builder.from.empty() || node_.empty()) return false;
    static_cast<void>(builder.copy(builder.from[0]));
    if (!builder.room) return false;
    nodes_ = builder.made;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        low_m_[axis] = static_cast<double>(low_m[i]);
        high_m_[axis] = static_cast<double>(high_m[i]);
    }
    mesh_ = full.with_tree(std::span(node_).first(nodes_));
    return true;
}

}  // namespace tact
