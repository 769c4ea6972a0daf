#include "prep/drilling/cavity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ipc/scene/density/isosurface.hpp"

namespace tact {
namespace {

using Size = std::array<std::uint32_t, 3>;

// A box of voxels of a volume, row by row, with a border of one voxel that is empty.
struct Box {
    Size low{}, size{};
    [[nodiscard]] std::size_t count() const { return std::size_t{size[0]} * size[1] * size[2]; }
    [[nodiscard]] std::size_t at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * size[1] + y) * size[0] + x;
    }
    [[nodiscard]] bool empty() const { return size[0] == 0; }
};

template <class Visit>
void each_voxel(const BoneBricks& bricks, const Visit& visit) {
    for (std::uint32_t z = 0; z < bricks.size[2]; ++z)
        for (std::uint32_t y = 0; y < bricks.size[1]; ++y)
            for (std::uint32_t x = 0; x < bricks.size[0]; ++x) visit(x, y, z, bricks.voxel(x, y, z));
}

// Around the voxels for which inside() holds.
template <class Inside>
Box box_of(const BoneBricks& bricks, const Inside& inside) {
    Size low{~0U, ~0U, ~0U}, high{};
    each_voxel(bricks, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::size_t v) {
        if (!inside(v)) return;
        const Size at{x, y, z};
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], at[a]);
            high[a] = std::max(high[a], at[a] + 1);
        }
    });
    Box box;
    if (high[0] == 0) return box;
    box.low = low;
    for (std::size_t a = 0; a < 3; ++a) box.size[a] = high[a] - low[a] + 2;
    return box;
}

// value(voxel) in the box, `outside` in its border.
template <class T, class Value>
std::vector<T> values_in(const BoneBricks& bricks, const Box& box, T outside, const Value& value) {
    std::vector<T> all(box.count(), outside);
    for (std::uint32_t z = 1; z + 1 < box.size[2]; ++z)
        for (std::uint32_t y = 1; y + 1 < box.size[1]; ++y)
            for (std::uint32_t x = 1; x + 1 < box.size[0]; ++x)
                all[box.at(x, y, z)] =
                    value(bricks.voxel(box.low[0] + x - 1, box.low[1] + y - 1, box.low[2] + z - 1));
    return all;
}

// Centre of the first voxel of the box.
Vec3 first_voxel(const Box& box) { return Vec3(box.low[0], box.low[1], box.low[2]).array() - 1.0; }

template <class Value>
TriangleMesh surface_of(const BoneBricks& bricks, double level, const Value& value,
                        const Progress& progress) {
    const Box box = box_of(bricks, [&](std::size_t v) { return static_cast<double>(value(v)) > 0.0; });
    if (box.empty()) return {};
    DensityGrid grid;
    grid.size = box.size;
    grid.origin_m = bricks.to_model(first_voxel(box));
    grid.spacing_m = Vec3::Constant(bricks.voxel_m);
    grid.values = values_in<float>(bricks, box, 0.0F, value);
    return isosurface(grid, level, progress);
}

// Squared distance, in voxels, to the nearest voxel that is marked: exact, one axis after the other, by the lower
// envelope of parabolas (Felzenszwalb and Huttenlocher, Distance transforms of sampled functions, 2012).
class Distances {
public:
    Distances(const Box& box, std::vector<float> marked) : box_(box), squared_(std::move(marked)) {
        const std::uint32_t longest = *std::max_element(box.size.begin(), box.size.end());
        line_.resize(longest);
        place_.resize(longest);
        border_.resize(longest + 1U);
        std::size_t step = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pass(axis, step);
            step *= box.size[axis];
        }
    }
    static constexpr float kFar = 1e12F;
    [[nodiscard]] float squared(std::size_t i) const { return squared_[i]; }

private:
    void pass(std::size_t axis, std::size_t step) {
        const std::size_t n = box_.size[axis], lines = squared_.size() / n;
        for (std::size_t l = 0; l < lines; ++l) {
            const std::size_t first = l / step * step * n + l % step;
            for (std::size_t i = 0; i < n; ++i) line_[i] = squared_[first + i * step];
            std::size_t last = 0;
            place_[0] = 0;
            border_[0] = -std::numeric_limits<double>::infinity();
            border_[1] = std::numeric_limits<double>::infinity();
            for (std::size_t q = 1; q < n; ++q) {
                double s = meet(place_[last], q);
                while (s <= border_[last]) s = meet(place_[--last], q);
                place_[++last] = q;
                border_[last] = s;
                border_[last + 1] = std::numeric_limits<double>::infinity();
            }
            for (std::size_t i = 0, k = 0; i < n; ++i) {
                while (border_[k + 1] < static_cast<double>(i)) ++k;
                const double d = static_cast<double>(i) - static_cast<double>(place_[k]);
                squared_[first + i * step] = static_cast<float>(d * d + line_[place_[k]]);
            }
        }
    }
    // Where the parabolas of two places are equal.
    [[nodiscard]] double meet(std::size_t a, std::size_t b) const {
        const auto x = static_cast<double>(a), y = static_cast<double>(b);
        return (line_[b] + y * y - line_[a] - x * x) / (2.0 * (y - x));
    }

    Box box_;
    std::vector<float> squared_;
    std::vector<double> line_, border_;
    std::vector<std::size_t> place_;
};

// Inside, with a neighbour outside.
bool at_border(const Box& box, const std::vector<std::uint8_t>& in, std::uint32_t x, std::uint32_t y,
               std::uint32_t z) {
    const std::size_t i = box.at(x, y, z), row = box.size[0], plane = row * box.size[1];
    return in[i] != 0 && (in[i - 1] == 0 || in[i + 1] == 0 || in[i - row] == 0 || in[i + row] == 0 ||
                          in[i - plane] == 0 || in[i + plane] == 0);
}

std::vector<std::size_t> border_of(const Box& box, const std::vector<std::uint8_t>& in) {
    std::vector<std::size_t> border;
    for (std::uint32_t z = 1; z + 1 < box.size[2]; ++z)
        for (std::uint32_t y = 1; y + 1 < box.size[1]; ++y)
            for (std::uint32_t x = 1; x + 1 < box.size[0]; ++x)
                if (at_border(box, in, x, y, z)) border.push_back(box.at(x, y, z));
    return border;
}

Distances distances_to(const Box& box, const std::vector<std::size_t>& places) {
    std::vector<float> marked(box.count(), Distances::kFar);
    for (const std::size_t i : places) marked[i] = 0.0F;
    return {box, std::move(marked)};
}

double voxel_mm3(const BoneBricks& bricks) { return std::pow(1e3 * bricks.voxel_m, 3); }

}  // namespace

std::vector<std::uint8_t> taken_voxels(std::span<const std::uint8_t> baked,
                                       std::span<const std::uint8_t> now) {
    std::vector<std::uint8_t> taken(baked.size());
    for (std::size_t i = 0; i < baked.size(); ++i)
        taken[i] = baked[i] >= kBoneLeast && 2 * now[i] <= baked[i] ? 1 : 0;
    return taken;
}

CavityVolumes cavity_volumes(const BoneVolumeView& baked, std::span<const std::uint8_t> now) {
    std::uint64_t levels = 0, voxels = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        levels += static_cast<std::uint64_t>(baked.density[i] - std::min(baked.density[i], now[i]));
        voxels += baked.density[i] >= kBoneLeast && 2 * now[i] <= baked.density[i] ? 1 : 0;
    }
    const double one = voxel_mm3(baked.bricks);
    return {one * static_cast<double>(levels) / 255.0, one * static_cast<double>(voxels)};
}

TriangleMesh bone_surface(const BoneVolumeView& now, const Progress& progress) {
    return surface_of(
        now.bricks, kBoneSurface, [&](std::size_t v) { return static_cast<float>(now.density[v]); },
        progress);
}

TriangleMesh cavity_surface(const BoneVolumeView& baked, std::span<const std::uint8_t> now,
                            const Progress& progress) {
    const auto gone = [&](std::size_t v) {
        const int was = baked.density[v];
        return was >= kBoneLeast
                   ? static_cast<float>(was - std::min<int>(was, now[v])) / static_cast<float>(was)
                   : 0.0F;
    };
    return surface_of(baked.bricks, 0.5, gone, progress);
}

CavityDifference compare_cavities(const BoneBricks& bricks, std::span<const std::uint8_t> a,
                                  std::span<const std::uint8_t> b) {
    std::uint64_t in_a = 0, in_b = 0, in_both = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        in_a += a[i];
        in_b += b[i];
        in_both += a[i] & b[i];
    }
    const double one = voxel_mm3(bricks);
    CavityDifference d{.a_mm3 = one * static_cast<double>(in_a),
                       .b_mm3 = one * static_cast<double>(in_b),
                       .both_mm3 = one * static_cast<double>(in_both),
                       .dice = {},
                       .mean_mm = {},
                       .p95_mm = {},
                       .largest_mm = {}};
    if (in_a + in_b > 0) d.dice = 2.0 * static_cast<double>(in_both) / static_cast<double>(in_a + in_b);
    if (in_a == 0 || in_b == 0) return d;
    const Box box = box_of(bricks, [&](std::size_t v) { return (a[v] | b[v]) != 0; });
    const auto in = [&](std::span<const std::uint8_t> set) {
        return values_in<std::uint8_t>(bricks, box, 0, [&](std::size_t v) { return set[v]; });
    };
    const std::vector<std::size_t> border_a = border_of(box, in(a)), border_b = border_of(box, in(b));
    std::vector<double> all_mm;
    const auto measure = [&](const std::vector<std::size_t>& from, const std::vector<std::size_t>& to) {
        const Distances distances = distances_to(box, to);
        for (const std::size_t i : from)
            all_mm.push_back(1e3 * bricks.voxel_m * std::sqrt(static_cast<double>(distances.squared(i))));
    };
    measure(border_a, border_b);
    measure(border_b, border_a);
    double sum = 0.0;
    for (const double mm : all_mm) sum += mm;
    std::sort(all_mm.begin(), all_mm.end());
    d.mean_mm = sum / static_cast<double>(all_mm.size());
    d.p95_mm = all_mm[static_cast<std::size_t>(0.95 * static_cast<double>(all_mm.size() - 1))];
    d.largest_mm = all_mm.back();
    return d;
}

std::vector<float> distances_from(const BoneBricks& bricks, std::span<const std::uint8_t> cavity,
                                  std::span<const float> position_m) {
    std::vector<float> signed_mm(position_m.size() / 3, 0.0F);
    const auto voxel_of = [&](std::size_t p) {
        return bricks.to_voxels(Vec3(static_cast<double>(position_m[3 * p]),
                                     static_cast<double>(position_m[3 * p + 1]),
                                     static_cast<double>(position_m[3 * p + 2])));
    };
    if (std::find(cavity.begin(), cavity.end(), std::uint8_t{1}) == cavity.end()) return signed_mm;
    Box box;
    for (std::size_t a = 0; a < 3; ++a) box.size[a] = bricks.size[a] + 2;
    const std::vector<std::uint8_t> in =
        values_in<std::uint8_t>(bricks, box, 0, [&](std::size_t v) { return cavity[v]; });
    const Distances distances = distances_to(box, border_of(box, in));
    for (std::size_t p = 0; p < signed_mm.size(); ++p) {
        const Vec3 at = voxel_of(p).array() + 1.0;
        Size cell{};
        for (std::size_t a = 0; a < 3; ++a)
            cell[a] = static_cast<std::uint32_t>(std::clamp(std::lround(at[static_cast<Eigen::Index>(a)]), 0L,
                                                            static_cast<long>(box.size[a]) - 1));
        const std::size_t i = box.at(cell[0], cell[1], cell[2]);
        const double mm = 1e3 * bricks.voxel_m * std::sqrt(static_cast<double>(distances.squared(i)));
        signed_mm[p] = static_cast<float>(in[i] != 0 ? -mm : mm);
    }
    return signed_mm;
}

}  // namespace tact
