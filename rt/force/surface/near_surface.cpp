#include "rt/force/surface/near_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tact {
namespace {

constexpr std::uint32_t kKeyBits = 9;  // of each axis
constexpr float kNoBox = std::numeric_limits<float>::infinity();

// The bits of a number two places apart.
std::uint32_t spread(std::uint32_t x) noexcept {
    x = (x | x << 16) & 0x030000FFU;
    x = (x | x << 8) & 0x0300F00FU;
    x = (x | x << 4) & 0x030C30C3U;
    return (x | x << 2) & 0x09249249U;
}

std::uint32_t nodes_for(std::uint32_t triangles) noexcept { return triangles / 12 + 64; }

}  // namespace

NearSurface::NearSurface(std::uint32_t capacity)
    : position_m_(std::size_t{9} * capacity),
      normal_(std::size_t{3} * capacity),
      corner_(std::size_t{3} * capacity),
      node_(nodes_for(capacity)),
      keyed_(capacity),
      other_(capacity) {
    std::iota(corner_.begin(), corner_.end(), 0U);
}

void NearSurface::build(const NearTriangles& near, const SurfaceMesh& full) noexcept {
    usable_ = near.complete && near.full_detail && near.step > 0 && near.count <= keyed_.size();
    step_ = near.step;
    count_ = usable_ ? near.count : 0;
    nodes_ = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
        low_m_[i] = static_cast<double>(near.low_m[static_cast<std::size_t>(i)]);
        high_m_[i] = static_cast<double>(near.high_m[static_cast<std::size_t>(i)]);
    }
    if (!usable_) return;
    sort(near);
    for (std::uint32_t t = 0; t < count_; ++t) {
        const NearTriangle& from = near.triangle[keyed_[t].from];
        const auto corner = full.corners(from.number);
        for (std::size_t k = 0; k < 3; ++k) {
            std::copy_n(from.corner_m[k].data(), 3, &position_m_[std::size_t{9} * t + 3 * k]);
            normal_[std::size_t{3} * t + k] = full.stored_normal(corner[k]);
        }
    }
    make_tree();
}

// By the place of their middles on a Morton curve; least digit first.
void NearSurface::sort(const NearTriangles& near) noexcept {
    std::array<float, 3> scale{};
    for (std::size_t i = 0; i < 3; ++i)
        scale[i] = static_cast<float>((1U << kKeyBits) - 1) /
                   (3.0F * std::max(near.high_m[i] - near.low_m[i], 1e-30F));
    for (std::uint32_t t = 0; t < count_; ++t) {
        const auto& corner = near.triangle[t].corner_m;
        std::uint32_t key = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float sum = corner[0][i] + corner[1][i] + corner[2][i] - 3.0F * near.low_m[i];
            const float cell = std::clamp(sum * scale[i], 0.0F, static_cast<float>((1U << kKeyBits) - 1));
            key |= spread(static_cast<std::uint32_t>(cell)) << i;
        }
        keyed_[t] = {key, t};
    }
    for (std::uint32_t shift = 0; shift < 3 * kKeyBits; shift += kKeyBits) {
        std::array<std::uint32_t, 1U << kKeyBits> begin{};
        for (std::uint32_t t = 0; t < count_; ++t) ++begin[keyed_[t].key >> shift & (begin.size() - 1)];
        std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0U);
        for (std::uint32_t t = 0; t < count_; ++t)
            other_[begin[keyed_[t].key >> shift & (begin.size() - 1)]++] = keyed_[t];
        keyed_.swap(other_);
    }
}

void NearSurface::make_tree() noexcept {
    const std::uint32_t leaves = std::max(1U, (count_ + 3) / 4);
    static_cast<void>(make_node(0, leaves));
}

// As prep/surface does it: children get whole powers of four of leaves.
std::uint32_t NearSurface::make_node(std::uint32_t first_leaf, std::uint32_t leaves) noexcept {
    const std::uint32_t at = nodes_++;
    SurfaceNode made{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        made.low_m[axis].fill(kNoBox);
        made.high_m[axis].fill(-kNoBox);
    }
    made.child.fill(SurfaceNode::kNone);
    std::uint32_t each = 1;
    while (4 * each < leaves) each *= 4;
    for (std::size_t k = 0; leaves > 0 && count_ > 0; ++k) {
        const std::uint32_t take = std::min(each, leaves);
        if (take == 1) {
            const std::uint32_t first = 4 * first_leaf, count = std::min(count_ - first, 4U);
            made.child[k] = SurfaceNode::leaf(first, count);
            for (std::size_t i = std::size_t{9} * first; i < std::size_t{9} * (first + count); ++i) {
                made.low_m[i % 3][k] = std::min(made.low_m[i % 3][k], position_m_[i]);
                made.high_m[i % 3][k] = std::max(made.high_m[i % 3][k], position_m_[i]);
            }
        } else {
            const std::uint32_t child = make_node(first_leaf, take);
            made.child[k] = child;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const SurfaceNode& below = node_[child];
                made.low_m[axis][k] = *std::min_element(below.low_m[axis].begin(), below.low_m[axis].end());
                made.high_m[axis][k] =
                    *std::max_element(below.high_m[axis].begin(), below.high_m[axis].end());
            }
        }
        first_leaf += take;
        leaves -= take;
    }
    node_[at] = made;
    return at;
}

SurfaceMesh NearSurface::mesh() const noexcept {
    return SurfaceMesh::view(std::span(position_m_).first(std::size_t{9} * count_),
                             std::span(normal_).first(std::size_t{3} * count_),
                             std::span(corner_).first(std::size_t{3} * count_),
                             std::span(node_).first(nodes_));
}

}  // namespace tact
