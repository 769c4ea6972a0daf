// Memory layout of a bone volume: contiguous cubes of 8 x 8 x 8 bytes, so that a burr touches few pages and
// changes are tracked per brick.
//
// Order    bricks with x fastest, then y, z; voxels inside a brick likewise. Voxels beyond the volume's
//          size, in its last bricks, are 0.
// Frame    model metres; voxel (0, 0, 0) is centred on origin_m, axes parallel
// Thread   any; no allocation
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

struct BoneBricks {
    static constexpr std::uint32_t kEdge = 8;
    static constexpr std::size_t kVoxels = std::size_t{kEdge} * kEdge * kEdge;  // per brick

    std::array<std::uint32_t, 3> size{};  // voxels
    double voxel_m = 0.0;                 // edge length of a voxel, the same along each axis
    Vec3 origin_m = Vec3::Zero();

    [[nodiscard]] std::array<std::uint32_t, 3> bricks() const noexcept {
        return {(size[0] + kEdge - 1) / kEdge, (size[1] + kEdge - 1) / kEdge, (size[2] + kEdge - 1) / kEdge};
    }
    [[nodiscard]] std::size_t brick_count() const noexcept {
        const auto n = bricks();
        return std::size_t{n[0]} * n[1] * n[2];
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return brick_count() * kVoxels; }
    // Index of the brick of a voxel, and index of the voxel. x, y, z below size.
    [[nodiscard]] std::size_t brick(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
        const auto n = bricks();
        return (std::size_t{z / kEdge} * n[1] + y / kEdge) * n[0] + x / kEdge;
    }
    [[nodiscard]] std::size_t voxel(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
        return brick(x, y, z) * kVoxels + (std::size_t{z % kEdge} * kEdge + y % kEdge) * kEdge + x % kEdge;
    }
    // In voxels, relative to the centre of voxel (0, 0, 0).
    [[nodiscard]] Vec3 to_voxels(const Vec3& model_m) const { return (model_m - origin_m) / voxel_m; }
    [[nodiscard]] Vec3 to_model(const Vec3& voxels) const { return origin_m + voxel_m * voxels; }
};

}  // namespace tact
