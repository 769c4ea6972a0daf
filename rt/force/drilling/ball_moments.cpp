#include "rt/force/drilling/ball_moments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {
namespace {

// Measured, see README.md.
constexpr double kDepthWhole = 0.35;                  // h / R from which on blocks are as large as asked
constexpr double kBlockPart = 0.2;                    // and the smallest part of that
constexpr double kMixed = 0.5;                        // of blocks that are partly bone
constexpr double kHalfDiagonal = 0.8660254037844386;  // of a cube of edge 1

class Walk {
public:
    Walk(const MomentOctree& octree, const BrickKernels& kernels, const Vec3& centre, double radius,
         double block, double mixed)
        : octree_(octree), kernels_(kernels), centre_(centre), radius_(radius), block_(block), mixed_(mixed) {
        reach_[0] = reach_of(4.0);
        for (std::uint32_t level = 0; level < octree.levels(); ++level)
            reach_[level + 1] = reach_of(static_cast<double>(8U << level));
    }

    BallMoments run() noexcept {
        // From blocks as large as the radius, of which the ball meets at most four along each axis.
        std::uint32_t level = 0;
        while (level + 1 < octree_.levels() && static_cast<double>(8U << level) < radius_) ++level;
        const double edge = static_cast<double>(8U << level);
        std::uint32_t first[3], last[3];
        for (int a = 0; a < 3; ++a) {
            const double most = octree_.blocks(level)[static_cast<std::size_t>(a)] - 1.0;
            const double from = std::floor((centre_[a] + 0.5 - radius_) / edge),
                         to = std::floor((centre_[a] + 0.5 + radius_) / edge);
            if (!(to >= 0.0 && from <= most)) return sums_;
            first[a] = static_cast<std::uint32_t>(std::max(from, 0.0));
            last[a] = static_cast<std::uint32_t>(std::min(to, most));
        }
        for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
            for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
                for (std::uint32_t x = first[0]; x <= last[0]; ++x) visit(level, x, y, z, 1.0);
            }
        }
        flush();
        return sums_;
    }

private:
    struct Reach {
        double edge, plane;        // where a block of this edge is cut: as far as its points are on average
        double inside2, outside2;  // squares of the distances at which one is wholly inside or outside
    };
    Reach reach_of(double edge) const noexcept {
        const double plane = std::sqrt(std::max(radius_ * radius_ - edge * edge / 6.0, 0.0));
        const double inside = plane - kHalfDiagonal * edge, outside = radius_ + kHalfDiagonal * edge;
        return {edge, plane, inside > 0.0 ? inside * inside : -1.0, outside * outside};
    }
    // How much of what a block holds is taken from the block itself: all where it is no larger than the smallest
    // looked at, nothing where its parts still are, and something between, so that a turn of the level is smooth.
    static double own_share(double block, double edge, double part) noexcept {
        return std::clamp((block - part) / (edge - part), 0.0, 1.0);
    }
    // Smaller blocks where bone and none share one: from nothing to a quarter of it.
    double block_for(double m0, double edge) noexcept {
        const double filled = m0 / (255.0 * edge * edge * edge);
        const double mixed = std::min(1.0, 16.0 * filled * (1.0 - filled));
        ++sums_.surface;
        sums_.mixed += mixed;
        return block_ * (1.0 - (1.0 - mixed_) * mixed);
    }

    void add_whole(const Vec3& from, double m0, const Vec3& m1, double weight) noexcept {
        sums_.m0 += weight * m0;
        sums_.m1 += weight * (m0 * from + m1);
    }
    void add_cut(const Reach& reach, const Vec3& from, double m0, const Vec3& m1, double weight) noexcept {
        for (int a = 0; a < 3; ++a) {
            cuts_.centre[a][cut_] = static_cast<float>(from[a]);
            cuts_.m1[a][cut_] = static_cast<float>(m1[a]);
        }
        cuts_.edge[cut_] = static_cast<float>(reach.edge);
        cuts_.limit[cut_] = static_cast<float>(reach.plane);
        cuts_.m0[cut_] = static_cast<float>(m0);
        weight_[cut_] = weight;
        if (++cut_ == kCuts) flush();
    }
    void flush() noexcept {
        if (cut_ == 0) return;
        for (std::size_t i = cut_; i < kCuts; ++i) {  // any block will do
            cuts_.edge[i] = 1.0F;
            cuts_.limit[i] = cuts_.m0[i] = 0.0F;
            for (int a = 0; a < 3; ++a) cuts_.centre[a][i] = cuts_.m1[a][i] = 0.0F;
        }
        kernels_.cut(cuts_);
        for (std::size_t i = 0; i < cut_; ++i) {
            sums_.m0 += weight_[i] * static_cast<double>(cuts_.cut_m0[i]);
            for (int a = 0; a < 3; ++a) sums_.m1[a] += weight_[i] * static_cast<double>(cuts_.cut_m1[a][i]);
        }
        cut_ = 0;
    }

    // From the ball's centre to that of a block.
    Vec3 from_centre(double edge, std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
        return {(x + 0.5) * edge - 0.5 - centre_.x(), (y + 0.5) * edge - 0.5 - centre_.y(),
                (z + 0.5) * edge - 0.5 - centre_.z()};
    }

    void visit(std::uint32_t level, std::uint32_t x, std::uint32_t y, std::uint32_t z,
               double weight) noexcept {
        if (level == 0) return visit_brick(x, y, z, weight);
        const BlockMoments& b = octree_.block(level, octree_.index(level, x, y, z));
        if (b.m0 == 0) return;
        ++sums_.blocks;
        const Reach& reach = reach_[level + 1];
        const Vec3 from = from_centre(reach.edge, x, y, z);
        const double far2 = from.squaredNorm();
        if (far2 >= reach.outside2) return;
        const auto m0 = static_cast<double>(b.m0);
        const Vec3 m1 = 0.5 * Vec3(static_cast<double>(b.m1[0]), static_cast<double>(b.m1[1]),
                                   static_cast<double>(b.m1[2]));
        if (far2 <= reach.inside2) return add_whole(from, m0, m1, weight);
        const double own = own_share(block_for(m0, reach.edge), reach.edge, 0.5 * reach.edge);
        if (own > 0.0) add_cut(reach, from, m0, m1, own * weight);
        if (own >= 1.0) return;
        const auto& n = octree_.blocks(level - 1);
        const double rest = weight * (1.0 - own);
        for (std::uint32_t k = 0; k < 8; ++k) {
            const std::uint32_t cx = 2 * x + (k & 1U), cy = 2 * y + (k >> 1U & 1U), cz = 2 * z + (k >> 2U);
            if (cx < n[0] && cy < n[1] && cz < n[2]) visit(level - 1, cx, cy, cz, rest);
        }
    }

    void visit_brick(std::uint32_t x, std::uint32_t y, std::uint32_t z, double weight) noexcept {
        const std::size_t i = octree_.index(0, x, y, z);
        const MomentOctree::Brick& b = octree_.brick(i);
        if (b.m0 == 0) return;
        ++sums_.blocks;
        const Reach& reach = reach_[1];
        const Vec3 from = from_centre(8.0, x, y, z);
        const double far2 = from.squaredNorm();
        if (far2 >= reach.outside2) return;
        const double m0 = b.m0;
        const Vec3 m1(0.5 * b.m1[0], 0.5 * b.m1[1], 0.5 * b.m1[2]);
        if (far2 <= reach.inside2) return add_whole(from, m0, m1, weight);
        const double block = block_for(m0, 8.0);
        const double own = own_share(block, 8.0, 4.0), parts = (1.0 - own) * own_share(block, 4.0, 2.0),
                     voxels = 1.0 - own - parts;
        if (own > 0.0) add_cut(reach, from, m0, m1, own * weight);
        if (parts > 0.0) add_parts(octree_.parts(i), from, parts * weight);
        if (voxels > 0.0) add_voxels(i, from, voxels * weight);
    }

    void add_parts(const MomentOctree::Parts& p, const Vec3& from, double weight) noexcept {
        const Reach& reach = reach_[0];
        for (std::size_t k = 0; k < 8; ++k) {
            if (p.m0[k] == 0) continue;
            ++sums_.blocks;
            ++sums_.parts;
            const Vec3 there = from + Vec3((k & 1U) != 0 ? 2.0 : -2.0, (k & 2U) != 0 ? 2.0 : -2.0,
                                           (k & 4U) != 0 ? 2.0 : -2.0);
            const double far2 = there.squaredNorm();
            if (far2 >= reach.outside2) continue;
            const Vec3 m1(0.5 * p.m1[0][k], 0.5 * p.m1[1][k], 0.5 * p.m1[2][k]);
            if (far2 <= reach.inside2)
                add_whole(there, p.m0[k], m1, weight);
            else
                add_cut(reach, there, p.m0[k], m1, weight);
        }
    }

    void add_voxels(std::size_t brick, const Vec3& from, double weight) noexcept {
        constexpr double kRamp =
            0.645497;  // half the width of a ramp with the variance of a voxel, sqrt(5 / 12)
        SumJob job;
        for (int a = 0; a < 3; ++a) job.first[a] = static_cast<float>(from[a] - 3.5);
        job.limit = static_cast<float>(radius_ * radius_ - 1.0 / 12.0);
        job.per_width = static_cast<float>(1.0 / (2.0 * radius_ * kRamp));
        BrickSums sums;
        kernels_.sum(job, octree_.density().data() + brick * BoneBricks::kVoxels, sums);
        constexpr double kPer = 1.0 / kSumOne;
        add_whole(from, kPer * sums.m0, 0.5 * kPer * Vec3(sums.m1[0], sums.m1[1], sums.m1[2]), weight);
        sums_.blocks += 512;
        ++sums_.bricks;
    }

    const MomentOctree& octree_;
    const BrickKernels& kernels_;
    Vec3 centre_;
    double radius_, block_, mixed_;
    Reach reach_[MomentOctree::kLevelsMax + 1];  // of blocks of 4, 8, 16 and so on
    BallMoments sums_;
    CutBlocks cuts_;
    double weight_[kCuts];
    std::size_t cut_ = 0;
};

}  // namespace

// The less the ball is in, the fewer blocks it touches and the more each matters: eq. 8.
double depth_part(double depth) noexcept { return std::clamp(depth / kDepthWhole, kBlockPart, 1.0); }

BallMoments ball_moments(const MomentOctree& octree, const BrickKernels& kernels, const Vec3& centre_voxels,
                         double radius_voxels, double block_voxels, double depth) noexcept {
    const double radius = std::max(radius_voxels, kRadiusLeast), most = kBlockMost * radius;
    std::uint32_t looked_at = 0;
    if (!(depth >= 0.0)) {
        const BallMoments rough = Walk(octree, kernels, centre_voxels, radius, most, 1.0).run();
        looked_at = rough.blocks;
        depth = std::sqrt(rough.m0 / (255.0 * std::numbers::pi)) / (radius * std::sqrt(radius));
    }
    const double part = depth_part(depth);
    BallMoments sums =
        Walk(octree, kernels, centre_voxels, radius, std::clamp(part * block_voxels, 1.0, most), kMixed)
            .run();
    sums.blocks += looked_at;
    return sums;
}

BallMoments ball_moments_exact(const MomentOctree& octree, const Vec3& centre_voxels, double radius_voxels,
                               int parts) {
    BallMoments sums;
    const BoneBricks& bricks = octree.bricks();
    std::int64_t first[3], last[3];
    for (int a = 0; a < 3; ++a) {
        first[a] = std::max<std::int64_t>(std::llround(std::floor(centre_voxels[a] - radius_voxels)), 0);
        last[a] =
            std::min<std::int64_t>(std::llround(std::ceil(centre_voxels[a] + radius_voxels)),
                                   static_cast<std::int64_t>(bricks.size[static_cast<std::size_t>(a)]) - 1);
    }
    const double square = radius_voxels * radius_voxels;
    const auto weight = 1.0 / (static_cast<double>(parts) * parts * parts);
    for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                const std::uint8_t level =
                    octree
                        .density()[bricks.voxel(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                                static_cast<std::uint32_t>(z))];
                if (level == 0) continue;
                const Vec3 from =
                    Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) -
                    centre_voxels;
                const double far = from.norm();
                if (far >= radius_voxels + kHalfDiagonal) continue;
                ++sums.blocks;
                if (far <= radius_voxels - kHalfDiagonal) {
                    sums.m0 += level;
                    sums.m1 += level * from;
                    continue;
                }
                for (int k = 0; k < parts * parts * parts; ++k) {
                    const Vec3 point =
                        from +
                        (Vec3(k % parts, k / parts % parts, k / (parts * parts)).array() + 0.5).matrix() /
                            parts -
                        Vec3::Constant(0.5);
                    if (point.squaredNorm() >= square) continue;
                    sums.m0 += weight * level;
                    sums.m1 += weight * level * point;
                }
            }
        }
    }
    return sums;
}

}  // namespace tact
