#include "rt/force/drilling/erosion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "rt/force/drilling/drill_bone.hpp"

namespace tact {

struct Erosion::Way {
    const BrickKernels* kernels;
    Vec3 from, way;
    double radius, per_way2;  // 1 / |way|^2; 0: it stands
    std::uint64_t key;
    std::uint32_t groups, first, count;
    ErodeJob job;

    bool asks_for(std::uint32_t group) const noexcept { return ((group - first) & (groups - 1)) < count; }
    // Of the centre of a block from the ball's way.
    double distance2(const Vec3& centre) const noexcept {
        const Vec3 d = centre - from;
        const double s = std::clamp(d.dot(way) * per_way2, 0.0, 1.0);
        return (d - s * way).squaredNorm();
    }
};

namespace {
constexpr double kHalfDiagonalOf = 0.8660254037844387;
constexpr std::uint32_t kFineGroups = 32;

// A fixed partition in which neighbours differ and each group is spread evenly: up to kFineGroups by the place of the
// brick; beyond, groups of the same blocks of eight bricks follow each other, so that a pass leaves out the others.
struct GroupOf {
    std::uint32_t block, place, places;
    GroupOf(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t groups) noexcept
        : place(x + 3 * y + 5 * z), places(std::min(groups, kFineGroups)) {
        const std::uint32_t bx = x >> 1U & 1U, by = y >> 1U & 1U, bz = z >> 1U & 1U;
        block = kFineGroups * (groups > 4 * kFineGroups   ? bx | by << 1U | bz << 2U
                               : groups > 2 * kFineGroups ? (bx ^ bz) | (by ^ bz) << 1U
                               : groups > kFineGroups     ? bx ^ by ^ bz
                                                          : 0);
    }
    // Of the brick that is `further` in x + 3 y + 5 z, in the same block of eight.
    [[nodiscard]] std::uint32_t at(std::uint32_t further) const noexcept {
        return block + ((place + further) & (places - 1));
    }
};
constexpr std::array<std::uint32_t, 8> kPlacesOfBlock{0, 1, 3, 4, 5, 6, 8, 9};

}  // namespace

Erosion::Erosion(MomentOctree& octree, std::span<std::uint8_t> density, std::span<std::uint32_t> revision,
                 std::uint64_t seed, StrokeHistory* strokes)
    : octree_(octree),
      density_(density),
      revision_(revision),
      seed_(seed),
      strokes_(strokes),
      dust_(kDustMax) {
    if (density.data() != octree.density().data() || density.size() != octree.density().size() ||
        revision.size() != octree.bricks().brick_count())
        throw StartupError("preparing the erosion of bone",
                           "densities or revisions are not those of the octree",
                           "this is a mistake of the program: report it");
}

void Erosion::begin() noexcept {
    pass_ = {};
    dust_count_ = 0;
    balls_ = 0;
    ++passes_;
}

void Erosion::cut(const BrickKernels& kernels, const CuttingBall& ball) noexcept {
    ++balls_;
    if (!(ball.exposure > 0.0)) return;
    Way w;
    w.kernels = &kernels;
    w.from = ball.from_voxels;
    w.way = ball.to_voxels - ball.from_voxels;
    w.radius = ball.radius_voxels;
    w.groups = ball.groups;
    w.first = ball.first;
    w.count = ball.count;
    if (w.way.squaredNorm() < 1e-8 * w.radius * w.radius) {  // the bend would be lost in rounding
        w.from += 0.5 * w.way;
        w.way.setZero();
    }
    const double way2 = w.way.squaredNorm();
    w.per_way2 = way2 > 0.0 ? 1.0 / way2 : 0.0;
    w.key = SeededRandom(seed_ ^ (passes_ * 0xD1342543DE82EF95ULL) ^ (std::uint64_t{balls_} << 56U)).next();
    for (int a = 0; a < 3; ++a) w.job.way[a] = static_cast<float>(w.way[a]);
    w.job.inverse = static_cast<float>(1.0 / (w.radius * w.radius));
    w.job.rate = static_cast<float>(ball.exposure);
    w.job.rate_of_solid = 1.0F;
    w.job.rate_per_level = static_cast<float>((ball.soft - 1.0) / 255.0);

    std::uint32_t level = 0;
    while (level + 1 < octree_.levels() && static_cast<double>(8U << level) < w.radius) ++level;
    const double edge = static_cast<double>(8U << level);
    std::uint32_t first[3], last[3];
    for (int a = 0; a < 3; ++a) {
        const double most = octree_.blocks(level)[static_cast<std::size_t>(a)] - 1.0;
        const double low = std::min(w.from[a], w.from[a] + w.way[a]) - w.radius,
                     high = std::max(w.from[a], w.from[a] + w.way[a]) + w.radius;
        const double begin = std::floor((low + 0.5) / edge), end = std::floor((high + 0.5) / edge);
        if (!(end >= 0.0 && begin <= most)) return;
        first[a] = static_cast<std::uint32_t>(std::max(begin, 0.0));
        last[a] = static_cast<std::uint32_t>(std::min(end, most));
    }
    for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
        for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
            for (std::uint32_t x = first[0]; x <= last[0]; ++x) visit(w, level, x, y, z);
        }
    }
}

void Erosion::visit(const Way& way, std::uint32_t level, std::uint32_t x, std::uint32_t y,
                    std::uint32_t z) noexcept {
    // Without a brick of these groups there is nothing to do. Blocks of more than eight bricks have all groups.
    if (level == 0 && !way.asks_for(GroupOf(x, y, z, way.groups).at(0))) return;
    if (level == 1) {
        const GroupOf group(2 * x, 2 * y, 2 * z, way.groups);
        if (std::none_of(kPlacesOfBlock.begin(), kPlacesOfBlock.end(),
                         [&](std::uint32_t further) { return way.asks_for(group.at(further)); }))
            return;
    }
    ++pass_.walked;
    const std::size_t i = octree_.index(level, x, y, z);
    if (level == 0 ? octree_.brick(i).m0 == 0 : octree_.block(level, i).m0 == 0) return;
    const double edge = static_cast<double>(8U << level), reach = way.radius + kHalfDiagonalOf * edge;
    const Vec3 centre((x + 0.5) * edge - 0.5, (y + 0.5) * edge - 0.5, (z + 0.5) * edge - 0.5);
    if (way.distance2(centre) >= reach * reach) return;
    if (level == 0) return cut_brick(way, x, y, z);
    const auto& n = octree_.blocks(level - 1);
    for (std::uint32_t k = 0; k < 8; ++k) {
        const std::uint32_t cx = 2 * x + (k & 1U), cy = 2 * y + (k >> 1U & 1U), cz = 2 * z + (k >> 2U);
        if (cx < n[0] && cy < n[1] && cz < n[2]) visit(way, level - 1, cx, cy, cz);
    }
}

void Erosion::cut_brick(const Way& way, std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
    const std::size_t i = octree_.index(0, x, y, z);
    ErodeJob job = way.job;
    const std::uint32_t place[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) job.first[a] = static_cast<float>(8.0 * place[a] - way.from[a]);
    job.key = static_cast<std::uint32_t>(SeededRandom(way.key + i).next() >> 32U);
    ++pass_.visited;
    std::uint8_t* const voxels = density_.data() + i * BoneBricks::kVoxels;
    if (strokes_ != nullptr) strokes_->look(static_cast<std::uint32_t>(i), voxels);
    const std::uint32_t levels = way.kernels->erode(job, voxels);
    if (levels == 0) return;
    if (strokes_ != nullptr) strokes_->keep(static_cast<std::uint32_t>(i));
    const MomentOctree::Brick lost = octree_.refresh(x, y, z);
    raise_revision(revision_[i]);
    pass_.removed += levels;
    removed_ += levels;
    ++pass_.bricks;
    if (dust_count_ == dust_.size()) {
        pass_.unlisted += levels;
        return;
    }
    BoneDust& dust = dust_[dust_count_++];
    dust.brick = static_cast<std::uint32_t>(i);
    dust.levels = levels;
    for (int a = 0; a < 3; ++a)
        dust.centre_voxels[a] =
            static_cast<float>(8.0 * place[a] + 3.5 + 0.5 * lost.m1[static_cast<std::size_t>(a)] / lost.m0);
}

}  // namespace tact
