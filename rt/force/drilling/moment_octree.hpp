// Mass and first moment of blocks of a bone volume: cubes of 4 and 8 voxels inside bricks, then 16, 32 and so on.
//
// Source   eq. 9 of Agus et al., Adaptive techniques for haptic and visual simulation of bone dissection
// Unit     mass: levels, 255 a voxel of solid bone. Moments: levels x half voxel edges, about the block's own centre.
//          Both are integers and exact; what a brick loses goes up as a difference, so they stay exact.
// Blocks   of 2 voxels are not kept: they are as large as the eight voxels that they would sum.
// Thread   built anywhere (may throw StartupError); then belongs to one. refresh() allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

struct BlockMoments {
    std::int64_t m0 = 0;
    std::array<std::int64_t, 3> m1{};
};

class MomentOctree {
public:
    // Of the eight blocks of 4 voxels of a brick, x fastest.
    struct alignas(64) Parts {
        std::array<std::int16_t, 8> m0;
        std::array<std::array<std::int16_t, 8>, 3> m1;
    };
    struct Brick {
        std::int32_t m0 = 0;
        std::array<std::int32_t, 3> m1{};
    };

    // The densities, in the order of bricks, must outlive the octree; it never writes to them.
    MomentOctree(const BoneBricks& bricks, std::span<const std::uint8_t> density);

    [[nodiscard]] const BoneBricks& bricks() const { return bricks_; }
    [[nodiscard]] std::span<const std::uint8_t> density() const { return density_; }
    // Level 0 are bricks, level n has blocks of 8 x 2^n voxels; the last one is a single block.
    [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }
    [[nodiscard]] const std::array<std::uint32_t, 3>& blocks(std::uint32_t level) const noexcept {
        return blocks_[level];
    }
    [[nodiscard]] std::size_t index(std::uint32_t level, std::uint32_t x, std::uint32_t y,
                                    std::uint32_t z) const noexcept {
        const auto& n = blocks_[level];
        return (std::size_t{z} * n[1] + y) * n[0] + x;
    }
    [[nodiscard]] const Brick& brick(std::size_t i) const noexcept { return brick_[i]; }
    [[nodiscard]] const Parts& parts(std::size_t i) const noexcept { return parts_[i]; }
    [[nodiscard]] const BlockMoments& block(std::uint32_t level, std::size_t i) const noexcept {  // level > 0
        return node_[level][i];
    }
    [[nodiscard]] BlockMoments total() const noexcept;

    // After densities of a brick changed: its moments, and those of all that hold it. Returns what it lost.
    Brick refresh(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept TACT_RT;

    static constexpr std::uint32_t kLevelsMax = 20;
    static constexpr std::size_t kBricksMax = std::size_t{1} << 23;  // 4 GiB; a voxel's number has 32 bits

private:
    BoneBricks bricks_;
    std::span<const std::uint8_t> density_;
    std::uint32_t levels_ = 1;
    std::array<std::array<std::uint32_t, 3>, kLevelsMax> blocks_{};
    HugeVector<Parts> parts_;
    HugeVector<Brick> brick_;
    std::array<std::vector<BlockMoments>, kLevelsMax> node_;  // none at level 0
};

// Of one brick's 512 densities.
void pull_brick(const std::uint8_t* voxels, MomentOctree::Parts& parts,
                MomentOctree::Brick& brick) noexcept TACT_RT;

}  // namespace tact
