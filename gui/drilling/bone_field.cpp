#include "gui/drilling/bone_field.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr int kReach = 2;  // voxels that smoothing looks at, on each side
constexpr std::array<std::uint32_t, 2 * kReach + 1> kWeight{1, 4, 6, 4, 1};
constexpr std::uint32_t kWeights = 16;
constexpr std::uint8_t kFaint = 48, kFull = 250;  // of a scan's partly filled voxels lie between
constexpr std::size_t kEveryVoxel = 13;           // looked at to tell
constexpr std::uint16_t kMixed = 256, kUnknown = 257;
constexpr double kPartlyFilled = 0.02;  // of the voxels with bone, at most in a segmented volume

}  // namespace

BoneField::BoneField(const BoneVolumeView& baked, const BoneLabelsView& labels, const BoneVolumeView& now,
                     std::span<const std::uint8_t> free_cells)
    : baked_(baked), labels_(labels), now_(now), smooth_(segmented()) {
    const auto n = now.bricks.bricks();
    constexpr std::uint32_t kCellsOfBrick = BoneBricks::kEdge / kCell;
    for (std::size_t i = 0; i < 3; ++i) cells_[i] = n[i] * kCellsOfBrick;
    free_.resize(std::size_t{cells_[0]} * cells_[1] * cells_[2]);
    if (smooth_) one_value_.assign(now.bricks.brick_count(), kUnknown);
    if (free_cells.size() == free_.size())
        std::copy(free_cells.begin(), free_cells.end(), free_.begin());
    else
        measure();
}

std::uint8_t BoneField::solid(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    const std::size_t v = now_.bricks.voxel(x, y, z);
    return solid_of(now_.density[v], baked_.density[v], label(v));
}

bool BoneField::segmented() const {
    std::uint64_t bone = 0, partly = 0;
    for (std::size_t i = 0; i < baked_.density.size(); i += kEveryVoxel) {
        const std::uint8_t d = baked_.density[i];
        bone += d > kFaint ? 1U : 0U;
        partly += d > kFaint && d < kFull ? 1U : 0U;
    }
    return bone > 0 && static_cast<double>(partly) <= kPartlyFilled * static_cast<double>(bone);
}

// Along one axis after the other, over the brick and two voxels around it.
void BoneField::smoothed(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const {
    constexpr int kEdge = BoneBricks::kEdge, kWide = kEdge + 2 * kReach;
    const auto n = now_.bricks.bricks();
    const std::array<int, 3> corner{static_cast<int>(brick % n[0]) * kEdge - kReach,
                                    static_cast<int>(brick / n[0] % n[1]) * kEdge - kReach,
                                    static_cast<int>(brick / n[0] / n[1]) * kEdge - kReach};
    std::array<std::uint16_t, std::size_t{kWide} * kWide * kWide> wide{}, along{};
    const auto inside = [&](int at, std::size_t axis) {
        return at >= 0 && at < static_cast<int>(now_.bricks.size[axis]);
    };
    const auto place = [](int x, int y, int z) {
        const auto whole = [](int i) { return static_cast<std::size_t>(i); };
        return (whole(z) * kWide + whole(y)) * kWide + whole(x);
    };
    for (int z = 0; z < kWide; ++z)
        for (int y = 0; y < kWide; ++y)
            for (int x = 0; x < kWide; ++x)
                if (inside(corner[0] + x, 0) && inside(corner[1] + y, 1) && inside(corner[2] + z, 2))
                    wide[place(x, y, z)] = solid(static_cast<std::uint32_t>(corner[0] + x),
                                                 static_cast<std::uint32_t>(corner[1] + y),
                                                 static_cast<std::uint32_t>(corner[2] + z));
    const auto pass = [&](std::size_t step, const std::array<bool, 3>& inner) {
        along = wide;
        const auto from = [&](std::size_t axis) { return inner[axis] ? kReach : 0; };
        const auto to = [&](std::size_t axis) { return inner[axis] ? kWide - kReach : kWide; };
        for (int z = from(2); z < to(2); ++z)
            for (int y = from(1); y < to(1); ++y)
                for (int x = from(0); x < to(0); ++x) {
                    const std::size_t first = place(x, y, z) - kReach * step;
                    std::uint32_t sum = kWeights / 2;
                    for (std::size_t i = 0; i < kWeight.size(); ++i)
                        sum += kWeight[i] * along[first + i * step];
                    wide[place(x, y, z)] = static_cast<std::uint16_t>(sum / kWeights);
                }
    };
    pass(1, {true, false, false});
    pass(kWide, {true, true, false});
    pass(std::size_t{kWide} * kWide, {true, true, true});
    for (int i = 0; i < static_cast<int>(out.size()); ++i)
        out[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(
            wide[place(kReach + i % kEdge, kReach + i / kEdge % kEdge, kReach + i / kEdge / kEdge)]);
}

void BoneField::as_stored(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const {
    const std::size_t first = std::size_t{brick} * BoneBricks::kVoxels;
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = solid_of(now_.density[first + i], baked_.density[first + i], label(first + i));
}

std::optional<std::uint8_t> BoneField::one_value_around(std::uint32_t brick) const {
    const auto n = now_.bricks.bricks();
    const std::array<std::uint32_t, 3> at{brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]};
    std::optional<std::uint8_t> value;
    // Outside of the volume there is nothing.
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (at[axis] == 0 || at[axis] + 1 == n[axis]) value = 0;
    for (std::uint32_t z = at[2] - std::min(at[2], 1U); z < std::min(at[2] + 2, n[2]); ++z)
        for (std::uint32_t y = at[1] - std::min(at[1], 1U); y < std::min(at[1] + 2, n[1]); ++y)
            for (std::uint32_t x = at[0] - std::min(at[0], 1U); x < std::min(at[0] + 2, n[0]); ++x) {
                std::uint16_t& known = one_value_[(std::size_t{z} * n[1] + y) * n[0] + x];
                if (known == kUnknown) {
                    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
                    as_stored((z * n[1] + y) * n[0] + x, voxels);
                    const bool same = std::all_of(voxels.begin(), voxels.end(),
                                                  [&](std::uint8_t v) { return v == voxels[0]; });
                    known = same ? voxels[0] : kMixed;
                }
                if (known == kMixed || (value && *value != known)) return std::nullopt;
                value = static_cast<std::uint8_t>(known);
            }
    return value;
}

void BoneField::solids(std::uint32_t brick, std::span<std::uint8_t, BoneBricks::kVoxels> out) const {
    if (!smooth_) return as_stored(brick, out);
    if (const auto value = one_value_around(brick))
        std::fill(out.begin(), out.end(), *value);
    else
        smoothed(brick, out);
}

double BoneField::reach_voxels(const Vec3& centre) const {
    double most = 0.0;
    for (std::size_t i = 0; i < free_.size(); ++i) {
        if (free_[i] != 0) continue;
        const std::size_t x = i % cells_[0], y = i / cells_[0] % cells_[1], z = i / cells_[0] / cells_[1];
        const Vec3 at(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        most = std::max(most, ((at.array() + 0.5) * double{kCell} - centre.array()).matrix().norm());
    }
    return most;
}

// Between two voxels the surface may lie up to a whole edge from the solid one. The voxels around a cell are
// therefore included, so that no surface lies in an empty cell; and those that smoothing spreads into it.
bool BoneField::empty(std::uint32_t cx, std::uint32_t cy, std::uint32_t cz) const {
    const std::array<std::uint32_t, 3> c{cx, cy, cz};
    std::array<std::uint32_t, 3> from{}, to{};
    const std::uint32_t around = smooth_ ? 1 + kReach : 1;
    for (std::size_t i = 0; i < 3; ++i) {
        from[i] = c[i] * kCell - std::min(c[i] * kCell, around);
        to[i] = std::min((c[i] + 1) * kCell + around, now_.bricks.size[i]);
    }
    for (std::uint32_t z = from[2]; z < to[2]; ++z)
        for (std::uint32_t y = from[1]; y < to[1]; ++y)
            for (std::uint32_t x = from[0]; x < to[0]; ++x)
                if (solid(x, y, z) >= kSurface) return false;
    return true;
}

void BoneField::changed(std::uint32_t brick, bool grown) {
    if (smooth_) one_value_[brick] = kUnknown;
    constexpr std::uint32_t kCellsOfBrick = BoneBricks::kEdge / kCell;
    const auto n = now_.bricks.bricks();
    const std::array<std::uint32_t, 3> brick_at{brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]};
    // A surface at the border of a brick is in the cells beside it, too.
    std::array<std::uint32_t, 3> from{}, to{};
    for (std::size_t i = 0; i < 3; ++i) {
        from[i] = brick_at[i] * kCellsOfBrick;
        to[i] = from[i] + kCellsOfBrick;
        if (!grown) continue;
        from[i] -= from[i] > 0 ? 1 : 0;
        to[i] = std::min(to[i] + 1, cells_[i]);
    }
    for (std::uint32_t z = from[2]; z < to[2]; ++z)
        for (std::uint32_t y = from[1]; y < to[1]; ++y)
            for (std::uint32_t x = from[0]; x < to[0]; ++x) {
                const std::size_t at = (std::size_t{z} * cells_[1] + y) * cells_[0] + x;
                std::uint8_t& cell = free_[at];
                if (empty(x, y, z)) {
                    cell = std::max(cell, std::uint8_t{1});
                } else if (cell > 0) {
                    cell = 0;
                    filled_.push_back(static_cast<std::uint32_t>(at));
                }
            }
}

// From the filled cells outwards, as far as cells are farther from all other bone.
bool BoneField::settle() {
    if (filled_.empty()) return false;
    constexpr std::uint32_t kMost = 255;
    const auto nx = static_cast<int>(cells_[0]), ny = static_cast<int>(cells_[1]),
               nz = static_cast<int>(cells_[2]);
    for (std::uint32_t distance = 1; distance < kMost && !filled_.empty(); ++distance) {
        next_.clear();
        for (const std::uint32_t at : filled_) {
            const auto i = static_cast<int>(at);
            const int x = i % nx, y = i / nx % ny, z = i / nx / ny;
            for (int c = std::max(z - 1, 0); c <= std::min(z + 1, nz - 1); ++c)
                for (int b = std::max(y - 1, 0); b <= std::min(y + 1, ny - 1); ++b)
                    for (int a = std::max(x - 1, 0); a <= std::min(x + 1, nx - 1); ++a) {
                        const auto beside = static_cast<std::uint32_t>((c * ny + b) * nx + a);
                        if (free_[beside] <= distance) continue;
                        free_[beside] = static_cast<std::uint8_t>(distance);
                        next_.push_back(beside);
                    }
        }
        filled_.swap(next_);
    }
    filled_.clear();
    return true;
}

void BoneField::mark_own() {
    std::fill(free_.begin(), free_.end(), std::uint8_t{1});
    const auto n = now_.bricks.bricks();
    constexpr std::uint32_t kCellsOfBrick = BoneBricks::kEdge / kCell;
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    for (std::uint32_t b = 0; b < now_.bricks.brick_count(); ++b) {
        as_stored(b, voxels);
        const std::size_t bx = b % n[0], by = b / n[0] % n[1], bz = b / n[0] / n[1];
        for (std::uint32_t i = 0; i < voxels.size(); ++i) {
            if (voxels[i] < kSurface) continue;
            const std::size_t x = bx * kCellsOfBrick + i % 8 / kCell,
                              y = by * kCellsOfBrick + i / 8 % 8 / kCell,
                              z = bz * kCellsOfBrick + i / 64 / kCell;
            free_[(z * cells_[1] + y) * cells_[0] + x] = 0;
        }
    }
}

// Distances by two sweeps: forward from the thirteen adjacent cells before a cell, backward from those after it.
void BoneField::measure() {
    constexpr int kMost = 255;
    const std::uint32_t nx = cells_[0], ny = cells_[1], nz = cells_[2];
    const auto place = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (std::size_t{z} * ny + y) * nx + x;
    };
    mark_own();
    // free_ is 1 where a cell's own voxels are all clear. Voxels are tested again only if an adjacent cell is not
    // clear.
    std::vector<std::uint8_t> none(free_.size());
    for (std::uint32_t z = 0; z < nz; ++z)
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t x = 0; x < nx; ++x) {
                bool clear = true;
                for (std::uint32_t c = z > 0 ? z - 1 : 0; c < std::min(z + 2, nz); ++c)
                    for (std::uint32_t b = y > 0 ? y - 1 : 0; b < std::min(y + 2, ny); ++b)
                        for (std::uint32_t a = x > 0 ? x - 1 : 0; a < std::min(x + 2, nx); ++a)
                            clear = clear && free_[place(a, b, c)] != 0;
                none[place(x, y, z)] = clear || (free_[place(x, y, z)] != 0 && empty(x, y, z)) ? 1 : 0;
            }
    for (std::size_t i = 0; i < free_.size(); ++i)
        free_[i] = none[i] != 0 ? static_cast<std::uint8_t>(kMost) : std::uint8_t{0};
    const auto sweep = [&](bool back) {
        for (std::size_t n = 0; n < free_.size(); ++n) {
            const std::size_t i = back ? free_.size() - 1 - n : n;
            int least = free_[i];
            if (least == 0) continue;
            const auto x = static_cast<int>(i % nx), y = static_cast<int>(i / nx % ny),
                       z = static_cast<int>(i / nx / ny);
            for (int k = 0; k < 13; ++k) {
                const int s = back ? -1 : 1;
                const int dx = s * (k % 3 - 1), dy = s * (k / 3 % 3 - 1), dz = s * (k / 9 - 1);
                const int ax = x + dx, ay = y + dy, az = z + dz;
                if (ax < 0 || ay < 0 || az < 0 || ax >= static_cast<int>(nx) || ay >= static_cast<int>(ny) ||
                    az >= static_cast<int>(nz))
                    continue;
                least = std::min(least,
                                 free_[place(static_cast<std::uint32_t>(ax), static_cast<std::uint32_t>(ay),
                                             static_cast<std::uint32_t>(az))] +
                                     1);
            }
            free_[i] = static_cast<std::uint8_t>(std::min(least, kMost));
        }
    };
    sweep(false);
    sweep(true);
}

}  // namespace tact
