// What a burr takes from bone, along the way that it made in a step.
//
// Source   eq. 12 of Agus et al.: d rho / dt = -a f(r / R) rho, f = 1 - (r / R)^2 inside the burr. Over a straight way the
//          integral of f has a closed form, E; a voxel keeps exp(-a E). Densities have 255 levels, so that what
//          a voxel loses is rounded up or down by a random number: right in expectation, whatever the servo's rate,
//          the burr's and the stroke's speed. Random numbers come from (seed, pass, ball, voxel), so runs repeat.
// Mass     counted in levels, 255 a voxel of solid bone. What the octree lost is what `removed` says, level by level.
// Frame    voxels, as in ball_moments.hpp
// Thread   one, that of the octree; no allocation after construction
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt/force/drilling/brick_kernels.hpp"
#include "rt/force/drilling/moment_octree.hpp"
#include "rt/force/drilling/stroke_history.hpp"

namespace tact {

// What one brick lost in one pass: dust appears about its middle.
struct BoneDust {
    std::uint32_t brick = 0;
    std::uint32_t levels = 0;
    float centre_voxels[3] = {0.0F, 0.0F, 0.0F};  // centre of mass of what went
};

struct ErosionPass {
    std::uint64_t removed = 0;   // levels
    std::uint32_t bricks = 0;    // that lost something
    std::uint32_t visited = 0;   // bricks whose voxels were computed: the work of the pass
    std::uint32_t walked = 0;    // blocks and bricks that were looked at to find them
    std::uint64_t unlisted = 0;  // of `removed`, what found no room in the list of dust
};

// A ball that cuts on its way.
struct CuttingBall {
    Vec3 from_voxels = Vec3::Zero(), to_voxels = Vec3::Zero();
    double radius_voxels = 1.0;
    double exposure = 0.0;  // a times the step's time: solid bone in the ball's centre keeps exp(-exposure)
    double soft = 1.0;      // the rate in the softest bone over that in solid bone; linear between
    // Of bricks in so many groups, a power of two up to 256, `count` from `first` on, in a circle (erosion_turns.hpp).
    std::uint32_t groups = 1, first = 0, count = 1;
};

class Erosion {
public:
    static constexpr std::size_t kDustMax = 4096;

    // Octree, densities (those of the octree), revisions (one a brick) and strokes must outlive it; null: they are not
    // kept. Fails by StartupError where sizes differ.
    Erosion(MomentOctree& octree, std::span<std::uint8_t> density, std::span<std::uint32_t> revision,
            std::uint64_t seed, StrokeHistory* strokes = nullptr);

    // Continues where another left off: its random numbers, and what it removed.
    void follow(const Erosion& before) noexcept TACT_RT {
        passes_ = before.passes_;
        removed_ = before.removed_;
    }
    // Begins a pass: the dust of the one before is forgotten.
    void begin() noexcept TACT_RT;
    void cut(const BrickKernels& kernels, const CuttingBall& ball) noexcept TACT_RT;

    [[nodiscard]] const ErosionPass& pass() const noexcept { return pass_; }
    [[nodiscard]] std::span<const BoneDust> dust() const noexcept { return {dust_.data(), dust_count_}; }
    [[nodiscard]] std::uint64_t passes() const noexcept { return passes_; }
    [[nodiscard]] std::uint64_t removed() const noexcept { return removed_; }  // in all passes
    [[nodiscard]] const MomentOctree& octree() const noexcept { return octree_; }

private:
    struct Way;
    void visit(const Way& way, std::uint32_t level, std::uint32_t x, std::uint32_t y,
               std::uint32_t z) noexcept TACT_RT;
    void cut_brick(const Way& way, std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept TACT_RT;

    MomentOctree& octree_;
    std::span<std::uint8_t> density_;
    std::span<std::uint32_t> revision_;
    std::uint64_t seed_;
    StrokeHistory* strokes_;
    std::uint64_t passes_ = 0, removed_ = 0;
    std::uint32_t balls_ = 0;  // of this pass
    ErosionPass pass_;
    std::vector<BoneDust> dust_;
    std::size_t dust_count_ = 0;
};

}  // namespace tact
