// Mass and first moment of the bone inside a ball, from the octree or voxel by voxel.
//
// Source   eqs 1, 10 and 11 of Agus et al.; blocks that the ball covers partly are cut by a plane instead of replaced
//          by balls (brick_kernels.hpp)
// Frame    voxels: lengths in voxel edges, from the centre of voxel (0, 0, 0); masses in levels, 255 a voxel of
//          solid bone
// Smooth   in the ball's place and in the block size, also where a block goes from partly to wholly covered
// Thread   any, while nobody changes the octree; no allocation
#pragma once

#include <cstdint>

#include "rt/force/drilling/brick_kernels.hpp"
#include "rt/force/drilling/moment_octree.hpp"

namespace tact {

struct BallMoments {
    double m0 = 0.0;
    Vec3 m1 = Vec3::Zero();     // about the ball's centre
    std::uint32_t blocks = 0;   // visited, voxels included
    std::uint32_t bricks = 0;   // of them summed voxel by voxel, each of which counts 512 in `blocks`
    std::uint32_t parts = 0;    // of them eighths of a brick
    std::uint32_t surface = 0;  // blocks that the ball covers partly
    double mixed = 0.0;         // of them those that are partly bone, by weight: looked at in halves
};

// block: edge of the smallest block looked at, at most kBlockMost of the radius; below 4 single voxels are counted, below 2 they alone. Blocks
// that are partly bone are looked at in blocks of half that size, and all of them where the ball is in the bone by
// less than a third of its radius. depth: h / R, roughly, that of the step before will do; below 0: a first look finds
// it. The radius is at least kRadiusLeast.
[[nodiscard]] BallMoments ball_moments(const MomentOctree& octree, const BrickKernels& kernels,
                                       const Vec3& centre_voxels, double radius_voxels, double block_voxels,
                                       double depth = -1.0) noexcept TACT_RT;
// The part of `block` that is used at a depth.
[[nodiscard]] double depth_part(double depth) noexcept TACT_RT;
inline constexpr double kBlockMost = 0.5;
inline constexpr double kRadiusLeast = 1.0;

// The reference: each voxel of the ball's surface is counted by parts^3 points. Slow.
[[nodiscard]] BallMoments ball_moments_exact(const MomentOctree& octree, const Vec3& centre_voxels,
                                             double radius_voxels, int parts = 8);

}  // namespace tact
