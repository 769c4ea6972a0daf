// Bone volumes for tests and benchmarks: densities of a shape, sampled at 27 points per voxel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"

namespace tact {

struct BoneBlock {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    std::vector<std::uint32_t> revision;

    // solid(point in voxels): the fraction of solid bone there, 0 to 1.
    template <class Solid>
    BoneBlock(std::uint32_t edge, double voxel_m, const Solid& solid, int parts = 3) {
        bricks.size = {edge, edge, edge};
        bricks.voxel_m = voxel_m;
        density.resize(bricks.bytes());
        revision.resize(bricks.brick_count());
        const double step = 1.0 / parts;
        for (std::uint32_t z = 0; z < edge; ++z) {
            for (std::uint32_t y = 0; y < edge; ++y) {
                for (std::uint32_t x = 0; x < edge; ++x) {
                    double sum = 0.0;
                    for (int k = 0; k < parts * parts * parts; ++k)
                        sum += solid(Vec3(x - 0.5 + step * (k % parts + 0.5),
                                          y - 0.5 + step * (k / parts % parts + 0.5),
                                          z - 0.5 + step * (k / (parts * parts) + 0.5)));
                    density[bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(
                        std::lround(255.0 * std::clamp(sum * step * step * step, 0.0, 1.0)));
                }
            }
        }
    }
};

}  // namespace tact
