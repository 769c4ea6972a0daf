// Work and error of a drilling step at a level, from what the last step found.
//
// Work     blocks and bricks that the force and the measurement of its stiffness visit, bricks that erosion computes and
//          changes; as counted in a step, or expected at another level. Blocks of the force go as (touched area) / block^2,
//          octree level by octree level; the last step's count sets the scale.
// Time     drill_speed.hpp
// Error    against the published equations: shares of the elastic force for blocks and voxels, bounds of what README.md
//          measured, and what the bone still to be cut may change: with e the exposure that is pending, a cap loses e s x m0 at most (its mean of 1 - (r/R)^2
//          is 2x/3, half as much again for other shapes), which changes eqs 2, 3, 13 and 14 by their slopes.
// Thread   any; constant time, no allocation
#pragma once

#include <cmath>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "rt/force/drilling/ball_moments.hpp"
#include "rt/force/drilling/burr_forces.hpp"

namespace tact {

struct DrillWork {
    double balls = 0.0, blocks = 0.0;  // whose moments were summed
    double parts = 0.0;                // eighths of bricks, in addition
    double summed = 0.0;               // bricks, voxel by voxel
    double cut = 0.0;                  // bricks whose voxels erosion computed
    double changed = 0.0;              // of them, those that lost something
    double walked = 0.0;               // blocks that erosion looked at to find them

    void add(const BallMoments& m) noexcept {
        balls += 1.0;
        blocks += static_cast<double>(m.blocks) - m.parts - 512.0 * m.bricks;
        parts += m.parts;
        summed += m.bricks;
    }
    void add(const DrillWork& w) noexcept {
        balls += w.balls;
        blocks += w.blocks;
        parts += w.parts;
        summed += w.summed;
        cut += w.cut;
        changed += w.changed;
        walked += w.walked;
    }
    // Balls, blocks and voxels.
    [[nodiscard]] std::uint32_t items() const noexcept {
        return static_cast<std::uint32_t>(std::lround(balls + blocks + parts + 512.0 * (summed + cut)));
    }
};

// Of a level: the smallest block over the radius, and how little blocks shrink near the surface: 0 as in ball_moments(),
// 1 not at all.
struct BlockDetail {
    double block = 0.1, rough = 0.0;
    // What to ask ball_moments() for, over the radius, for a ball at this depth (below 0: unknown).
    [[nodiscard]] double asked(double depth) const noexcept TACT_RT;
};

// What the blocks of one ball depend on, in voxels.
struct BallLook {
    double radius = 1.0, depth = 0.0;  // h / R
    double block = 0.0;                // smallest, as asked; 0: there was no look
    double mixed = 1.0;                // of the blocks in its surface, those that are partly bone
};
// The force's part of `found`, which a look at `as` found, at another smallest block.
[[nodiscard]] DrillWork expected_work(const DrillWork& found, const BallLook& as,
                                      double block) noexcept TACT_RT;

// shallow_n: the part of the elastic force for which rough blocks are too large, by shallow_share() of each ball's.
[[nodiscard]] double block_error_n(const BlockDetail& detail, double elastic_n,
                                   double shallow_n) noexcept TACT_RT;
[[nodiscard]] double shallow_share(double depth) noexcept TACT_RT;  // 0 where blocks do not shrink, to 1
// Error of one ball, because bone is known by voxels only. elastic_full_n: elastic force at h = R; voxel: in radii.
[[nodiscard]] double voxel_error_n(double elastic_full_n, double depth, double voxel) noexcept TACT_RT;
// Newtons per exposure that is pending, of a ball of weight 1.
[[nodiscard]] double pending_error_n(const BurrLaw& law, double radius_m, double soft, const BurrForce& force,
                                     double m0_m3, double m1_m4, double speed_m_s) noexcept TACT_RT;

}  // namespace tact
