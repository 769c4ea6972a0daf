// Copies rows of voxels from bricks and into bricks.
#pragma once

#include <cstring>
#include <span>

#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

// `row` holds whole bricks: a multiple of 8 voxels, at least bricks.size[0].
inline void brick_row(const BoneBricks& bricks, std::span<const std::uint8_t> voxel, std::uint32_t y,
                      std::uint32_t z, std::span<std::uint8_t> row) {
    const std::uint8_t* from = voxel.data() + bricks.voxel(0, y, z);
    for (std::size_t x = 0; x < bricks.size[0]; x += BoneBricks::kEdge, from += BoneBricks::kVoxels)
        std::memcpy(row.data() + x, from, BoneBricks::kEdge);
}

inline std::size_t brick_row_bytes(const BoneBricks& bricks) {
    return std::size_t{bricks.bricks()[0]} * BoneBricks::kEdge;
}

}  // namespace tact
