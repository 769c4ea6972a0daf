#include "rt/force/drilling/trial_bone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tact {
namespace {

constexpr double kBesideVoxels = 16.0;
constexpr std::uint8_t kBone = 128;

// Height of the uppermost bone of a column; nothing: it has none.
std::optional<std::uint32_t> top_of(const BoneBricks& bricks, std::span<const std::uint8_t> density,
                                    std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t z = bricks.size[2]; z-- > 0;)
        if (density[bricks.voxel(x, y, z)] >= kBone) return z;
    return std::nullopt;
}

using Column = std::array<std::uint32_t, 2>;

// One column of each brick is asked.
std::optional<Column> middle_column(const BoneBricks& bricks, std::span<const std::uint8_t> density) {
    const auto far2 = [&](const Column& c) {
        const double x = c[0] - 0.5 * bricks.size[0], y = c[1] - 0.5 * bricks.size[1];
        return x * x + y * y;
    };
    std::vector<Column> columns;
    for (std::uint32_t y = BoneBricks::kEdge / 2; y < bricks.size[1]; y += BoneBricks::kEdge)
        for (std::uint32_t x = BoneBricks::kEdge / 2; x < bricks.size[0]; x += BoneBricks::kEdge)
            columns.push_back({x, y});
    std::sort(columns.begin(), columns.end(),
              [&](const Column& a, const Column& b) { return far2(a) < far2(b); });
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const Column& c) { return top_of(bricks, density, c[0], c[1]); });
    return found == columns.end() ? std::nullopt : std::optional(*found);
}

// Height of the lowest point of a ball above a column that touches the bone from above.
double touch_height(const BoneBricks& bricks, std::span<const std::uint8_t> density, const Column& at,
                    double radius) {
    const auto first = [radius](std::uint32_t of) {
        return static_cast<std::uint32_t>(std::max(std::ceil(of - radius), 0.0));
    };
    const auto end = [radius](std::uint32_t of, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::min(std::floor(of + radius) + 1.0, static_cast<double>(size)));
    };
    double lowest = 0.0;
    for (std::uint32_t y = first(at[1]); y < end(at[1], bricks.size[1]); ++y) {
        for (std::uint32_t x = first(at[0]); x < end(at[0], bricks.size[0]); ++x) {
            const double dx = static_cast<double>(x) - at[0], dy = static_cast<double>(y) - at[1],
                         rest2 = radius * radius - dx * dx - dy * dy;
            if (rest2 < 0.0) continue;
            if (const auto top = top_of(bricks, density, x, y))
                lowest = std::max(lowest, *top + 0.5 + std::sqrt(rest2) - radius);
        }
    }
    return lowest;
}

}  // namespace

TrialBone solid_bone(double radius_m, double voxel_m) {
    TrialBone made;
    BoneBricks& bricks = made.bricks;
    const double side = 2.0 * radius_m / voxel_m + kBesideVoxels, deep = radius_m / voxel_m + kBesideVoxels;
    const auto whole = [](double voxels) {
        return BoneBricks::kEdge * static_cast<std::uint32_t>(std::ceil(voxels / BoneBricks::kEdge));
    };
    bricks.size = {whole(side), whole(side), whole(deep)};
    bricks.voxel_m = voxel_m;
    bricks.origin_m = voxel_m * Vec3(-0.5 * bricks.size[0], -0.5 * bricks.size[1], 0.5 - bricks.size[2]);
    made.density.assign(bricks.bytes(), 255);
    return made;
}

TrialBone bone_of(const BoneBricks& from, std::span<const std::uint8_t> density, double radius_m,
                  double depth_m, double voxel_m) {
    const auto column = middle_column(from, density);
    if (!column) return solid_bone(radius_m, voxel_m);
    const double radius = radius_m / voxel_m, beside = radius + 0.5 * kBesideVoxels;
    const Vec3 touch((*column)[0], (*column)[1], touch_height(from, density, *column, radius));
    const Vec3 low = touch - Vec3(beside, beside, depth_m / voxel_m + kBesideVoxels),
               high = touch + Vec3(beside, beside, radius);
    TrialBone made;
    std::array<std::uint32_t, 3> first{}, count{};
    const auto all = from.bricks();
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        const auto brick = [&](double voxel) {
            return static_cast<std::uint32_t>(
                std::clamp(std::floor(voxel / BoneBricks::kEdge), 0.0, all[a] - 1.0));
        };
        first[a] = brick(low[axis]);
        count[a] = brick(high[axis]) + 1 - first[a];
        made.bricks.size[a] = BoneBricks::kEdge * count[a];
        made.bricks.origin_m[axis] = voxel_m * (BoneBricks::kEdge * first[a] - touch[axis]);
    }
    made.bricks.voxel_m = voxel_m;
    made.density.resize(made.bricks.bytes());
    for (std::uint32_t z = 0; z < count[2]; ++z) {
        for (std::uint32_t y = 0; y < count[1]; ++y) {
            // Bricks of a row follow each other.
            const std::size_t source =
                                  (std::size_t{first[2] + z} * all[1] + first[1] + y) * all[0] + first[0],
                              target = (std::size_t{z} * count[1] + y) * count[0];
            std::copy_n(density.begin() + static_cast<std::ptrdiff_t>(source * BoneBricks::kVoxels),
                        count[0] * BoneBricks::kVoxels,
                        made.density.begin() + static_cast<std::ptrdiff_t>(target * BoneBricks::kVoxels));
        }
    }
    return made;
}

}  // namespace tact
