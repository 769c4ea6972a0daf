#include "rt/force/drilling/moment_octree.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

// Eight numbers along x, of a sum over y and z of half a brick.
using Row [[gnu::vector_size(16)]] = std::int16_t;
using RowBytes [[gnu::vector_size(8)]] = std::uint8_t;

Row row_at(const std::uint8_t* voxels) noexcept {
    RowBytes bytes;
    std::memcpy(&bytes, voxels, sizeof bytes);
    return __builtin_convertvector(bytes, Row);
}

// The four numbers of each half of a row, summed with weights 1 or -3, -1, 1, 3.
struct Halves {
    std::int16_t low, high;
};
Halves halves(const Row& row, bool moment) noexcept {
    const Row weight = moment ? Row{-3, -1, 1, 3, -3, -1, 1, 3} : Row{1, 1, 1, 1, 1, 1, 1, 1};
#if defined(__SSE2__)
    const __m128i pairs = _mm_madd_epi16(reinterpret_cast<__m128i>(row), reinterpret_cast<__m128i>(weight));
    const __m128i sums = _mm_add_epi32(pairs, _mm_shuffle_epi32(pairs, 0xB1));
    return {static_cast<std::int16_t>(_mm_cvtsi128_si32(sums)),
            static_cast<std::int16_t>(_mm_cvtsi128_si32(_mm_shuffle_epi32(sums, 0xEE)))};
#else
    const Row w = row * weight;
    return {static_cast<std::int16_t>(w[0] + w[1] + w[2] + w[3]),
            static_cast<std::int16_t>(w[4] + w[5] + w[6] + w[7])};
#endif
}

// Of a child about the centre of its parent: side is -1 or 1 along each axis, reach half the child's edge in half
// voxel edges.
template <class Parent, class Child>
void add_child(Parent& parent, const Child& child, std::int32_t x, std::int32_t y, std::int32_t z,
               std::int32_t reach) noexcept {
    using Number = std::remove_reference_t<decltype(parent.m0)>;
    const auto m0 = static_cast<Number>(child.m0);
    parent.m0 += m0;
    const std::int32_t side[3] = {x, y, z};
    for (std::size_t a = 0; a < 3; ++a)
        parent.m1[a] += static_cast<Number>(child.m1[a]) + m0 * (side[a] * reach);
}

std::int32_t side_of(std::uint32_t place) noexcept { return (place & 1U) != 0 ? 1 : -1; }

}  // namespace

// Every sum of at most 64 densities times 3 fits 16 bits: a quarter of a block at 3 and one at 1 is the most.
void pull_brick(const std::uint8_t* voxels, MomentOctree::Parts& parts, MomentOctree::Brick& brick) noexcept {
    for (std::uint32_t zh = 0; zh < 2; ++zh) {
        for (std::uint32_t yh = 0; yh < 2; ++yh) {
            Row sum{}, along_y{}, along_z{};
            for (std::uint32_t z = 0; z < 4; ++z) {
                const std::uint8_t* at = voxels + (zh * 4 + z) * 64 + yh * 32;
                const Row r0 = row_at(at), r1 = row_at(at + 8), r2 = row_at(at + 16), r3 = row_at(at + 24);
                const Row s = (r0 + r3) + (r1 + r2);
                sum += s;
                along_y += 3 * (r3 - r0) + (r2 - r1);
                along_z += static_cast<std::int16_t>(2 * static_cast<int>(z) - 3) * s;
            }
            const std::size_t low = zh * 4 + yh * 2;
            const auto put = [low](std::array<std::int16_t, 8>& to, const Halves& v) {
                to[low] = v.low;
                to[low + 1] = v.high;
            };
            put(parts.m0, halves(sum, false));
            put(parts.m1[0], halves(sum, true));
            put(parts.m1[1], halves(along_y, false));
            put(parts.m1[2], halves(along_z, false));
        }
    }
    brick = {};
    for (std::uint32_t k = 0; k < 8; ++k) {
        const MomentOctree::Brick child{parts.m0[k], {parts.m1[0][k], parts.m1[1][k], parts.m1[2][k]}};
        add_child(brick, child, side_of(k), side_of(k >> 1U), side_of(k >> 2U), 4);
    }
}

MomentOctree::MomentOctree(const BoneBricks& bricks, std::span<const std::uint8_t> density)
    : bricks_(bricks), density_(density) {
    const std::string attempt = "preparing a bone volume for drilling";
    if (!std::isfinite(bricks.voxel_m) || !(bricks.voxel_m > 0.0) || !bricks.origin_m.allFinite())
        throw StartupError(attempt, "its voxels have no size or no place", "bake it anew");
    for (const std::uint32_t n : bricks.size) {
        if (n == 0 || n > 1U << 16U)
            throw StartupError(attempt, "it has no voxels or too many", "bake it anew");
    }
    const std::size_t count = bricks.brick_count();
    if (count > kBricksMax)
        throw StartupError(attempt, "it has more than 4 GiB of voxels", "crop it, or take larger voxels");
    if (density.size() != bricks.bytes())
        throw StartupError(attempt,
                           "there are " + std::to_string(density.size()) + " densities for " +
                               std::to_string(bricks.bytes()) + " voxels",
                           "bake it anew");
    blocks_[0] = bricks.bricks();
    while (*std::max_element(blocks_[levels_ - 1].begin(), blocks_[levels_ - 1].end()) > 1) {
        for (std::size_t a = 0; a < 3; ++a) blocks_[levels_][a] = (blocks_[levels_ - 1][a] + 1) / 2;
        const auto& n = blocks_[levels_];
        node_[levels_].resize(std::size_t{n[0]} * n[1] * n[2]);
        ++levels_;
    }
    parts_.resize(count);
    brick_.resize(count);
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < blocks_[0][2]; ++z) {
        for (std::uint32_t y = 0; y < blocks_[0][1]; ++y) {
            for (std::uint32_t x = 0; x < blocks_[0][0]; ++x, ++i) {
                pull_brick(density.data() + i * BoneBricks::kVoxels, parts_[i], brick_[i]);
                if (levels_ > 1 && brick_[i].m0 != 0)
                    add_child(node_[1][index(1, x / 2, y / 2, z / 2)], brick_[i], side_of(x), side_of(y),
                              side_of(z), 8);
            }
        }
    }
    for (std::uint32_t level = 1; level + 1 < levels_; ++level) {
        i = 0;
        for (std::uint32_t z = 0; z < blocks_[level][2]; ++z) {
            for (std::uint32_t y = 0; y < blocks_[level][1]; ++y) {
                for (std::uint32_t x = 0; x < blocks_[level][0]; ++x, ++i)
                    add_child(node_[level + 1][index(level + 1, x / 2, y / 2, z / 2)], node_[level][i],
                              side_of(x), side_of(y), side_of(z), 8 << level);
            }
        }
    }
}

BlockMoments MomentOctree::total() const noexcept {
    if (levels_ > 1) return node_[levels_ - 1][0];
    const Brick& b = brick_[0];
    return {b.m0, {b.m1[0], b.m1[1], b.m1[2]}};
}

MomentOctree::Brick MomentOctree::refresh(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
    const std::size_t i = index(0, x, y, z);
    const Brick before = brick_[i];
    pull_brick(density_.data() + i * BoneBricks::kVoxels, parts_[i], brick_[i]);
    Brick lost = before;
    lost.m0 -= brick_[i].m0;
    for (std::size_t a = 0; a < 3; ++a) lost.m1[a] -= brick_[i].m1[a];
    BlockMoments up{-lost.m0, {-lost.m1[0], -lost.m1[1], -lost.m1[2]}};
    for (std::uint32_t level = 1; level < levels_; ++level) {
        for (std::size_t a = 0; a < 3; ++a)
            up.m1[a] += up.m0 * (side_of(a == 0 ? x : a == 1 ? y : z) * (std::int64_t{4} << level));
        x /= 2;
        y /= 2;
        z /= 2;
        BlockMoments& block = node_[level][index(level, x, y, z)];
        block.m0 += up.m0;
        for (std::size_t a = 0; a < 3; ++a) block.m1[a] += up.m1[a];
    }
    return lost;
}

}  // namespace tact
