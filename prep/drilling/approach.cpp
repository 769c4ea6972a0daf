#include "prep/drilling/approach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact {
namespace {

constexpr double kEveryM = 1e-3;      // distance between candidate places
constexpr double kTimesUneven = 5.0;  // extra distance accepted per unit of mean height difference of a patch

}  // namespace

BoneHeights::BoneHeights(const BoneBricks& bricks)
    : bricks_(bricks), solid_(std::size_t{bricks.size[0]} * bricks.size[1], kNone), any_(solid_) {}

void BoneHeights::add_row(std::uint32_t y, std::uint32_t z, std::span<const std::uint8_t> row) {
    const std::size_t first = std::size_t{y} * bricks_.size[0];
    const auto height = static_cast<std::int32_t>(z);
    for (std::uint32_t x = 0; x < bricks_.size[0]; ++x) {
        if (row[x] == 0) continue;
        any_[first + x] = std::max(any_[first + x], height);
        if (row[x] < kSolid) continue;
        solid_[first + x] = std::max(solid_[first + x], height);
        some_solid_ = true;
    }
}

std::int32_t BoneHeights::top(std::int64_t x, std::int64_t y) const {
    if (x < 0 || y < 0 || x >= bricks_.size[0] || y >= bricks_.size[1]) return kNone;
    const auto at = static_cast<std::size_t>(y) * bricks_.size[0] + static_cast<std::size_t>(x);
    return some_solid_ ? solid_[at] : any_[at];
}

// Calls column(x, y) for all columns within a radius, including columns outside the volume.
template <class F>
void BoneHeights::around(std::uint32_t x, std::uint32_t y, double radius_m, F column) const {
    const double most = std::max(bricks_.size[0], bricks_.size[1]);
    const auto reach = static_cast<std::int64_t>(std::min(radius_m / bricks_.voxel_m, most));
    for (std::int64_t dy = -reach; dy <= reach; ++dy)
        for (std::int64_t dx = -reach; dx <= reach; ++dx)
            if (dx * dx + dy * dy <= reach * reach) column(std::int64_t{x} + dx, std::int64_t{y} + dy);
}

BoneHeights::Place BoneHeights::place(const Vec3& middle_m) const {
    const auto& heights = some_solid_ ? solid_ : any_;
    const std::int32_t highest = *std::max_element(heights.begin(), heights.end());
    const auto every = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(kEveryM / bricks_.voxel_m));
    const Vec3 from(middle_m.x(), middle_m.y(), bricks_.to_model(Vec3(0.0, 0.0, highest)).z());
    const double flat = kFlatM / bricks_.voxel_m;
    double least = std::numeric_limits<double>::infinity();
    std::array<std::uint32_t, 2> best{};
    for (std::uint32_t y = 0; y < bricks_.size[1]; y += every)
        for (std::uint32_t x = 0; x < bricks_.size[0]; x += every) {
            const std::int32_t z = top(x, y);
            if (z == kNone) continue;
            const double far = (bricks_.to_model(Vec3(x, y, z)) - from).norm();
            if (far >= least) continue;
            int all = 0, level = 0;
            double differences = 0.0;
            around(x, y, kPatchM, [&](std::int64_t ax, std::int64_t ay) {
                const std::int32_t there = top(ax, ay);
                const double difference = there == kNone ? flat : std::min<double>(std::abs(there - z), flat);
                ++all;
                level += difference < flat ? 1 : 0;
                differences += difference;
            });
            const double cost = far + kTimesUneven * bricks_.voxel_m * differences / all;
            if (level < kCovered * all || cost >= least) continue;
            least = cost;
            best = {x, y};
        }
    if (!(least < std::numeric_limits<double>::infinity())) {
        const auto at =
            static_cast<std::size_t>(std::max_element(heights.begin(), heights.end()) - heights.begin());
        best = {static_cast<std::uint32_t>(at % bricks_.size[0]),
                static_cast<std::uint32_t>(at / bricks_.size[0])};
    }
    std::int32_t front = top(best[0], best[1]);
    const Vec3 surface_m = bricks_.to_model(Vec3(best[0], best[1], front));
    // Voxels of any density count here: a hand at rest touches nothing.
    around(best[0], best[1], kAroundM, [&](std::int64_t ax, std::int64_t ay) {
        if (ax < 0 || ay < 0 || ax >= bricks_.size[0] || ay >= bricks_.size[1]) return;
        front = std::max(front,
                         any_[static_cast<std::size_t>(ay) * bricks_.size[0] + static_cast<std::size_t>(ax)]);
    });
    return {surface_m, bricks_.to_model(Vec3(0.0, 0.0, front)).z()};
}

}  // namespace tact
