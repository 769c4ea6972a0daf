// Method. The squared distance to one cube is the sum over the axes of max(|d| - 1/2, 0)^2 voxels, so the squared
// distance to a set of cubes is a minimum over each axis in turn (Felzenszwalb, Huttenlocher 2012). Rows are reduced to
// grid points first, then columns, then planes. Distances inside the structure are computed within its bounding box
// only. Distances at grid points are exact to half a quantum of their 16 bits. A distance function changes by no more
// than the distance moved, so between grid points the error is at most sqrt(3)/2 of the spacing.
#include "prep/drilling/distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prep/drilling/brick_rows.hpp"

namespace tact {
namespace {

constexpr float kNowhere = 1e30F;
constexpr std::uint32_t kNoneInRow = UINT32_MAX;

float gap_squared(std::uint32_t voxels) {
    const float d = voxels > 0 ? static_cast<float>(voxels) - 0.5F : 0.0F;
    return d * d;
}

// One axis: from voxels low to high - 1 to the grid points that lie among them, or beyond the last voxel.
struct DistanceAxis {
    std::uint32_t low, high, step, first, points;
    std::vector<float> gap;  // squared distance from each voxel to each point
    DistanceAxis(std::uint32_t from, std::uint32_t to, std::uint32_t each, std::uint32_t end)
        : low(from),
          high(to),
          step(each),
          first((from + each - 1) / each),
          points(end > first ? end - first : 0) {
        gap.resize(std::size_t{high - low} * points);
        for (std::uint32_t i = 0; i < high - low; ++i)
            for (std::uint32_t j = 0; j < points; ++j)
                gap[std::size_t{i} * points + j] =
                    gap_squared(i + low > at(j) ? i + low - at(j) : at(j) - i - low);
    }
    [[nodiscard]] std::uint32_t at(std::uint32_t j) const { return (first + j) * step; }
    // best[j]: the minimum of value plus gap over the voxels that have a value.
    void reduce(const float* value, float* best) const {
        std::fill(best, best + points, kNowhere);
        for (std::uint32_t i = 0; i < high - low; ++i) {
            if (value[i] >= kNowhere) continue;
            const float* const g = gap.data() + std::size_t{i} * points;
            const float v = value[i];
            for (std::uint32_t j = 0; j < points; ++j) best[j] = v + g[j] < best[j] ? v + g[j] : best[j];
        }
    }
};
using DistanceAxes = std::array<DistanceAxis, 3>;

// Bounding box of a label: voxels low to high - 1.
struct LabelBox {
    std::array<std::uint32_t, 3> low{UINT32_MAX, UINT32_MAX, UINT32_MAX}, high{};
};

LabelBox box_of(const BoneBricks& bricks, std::span<const std::uint8_t> label, std::uint8_t of) {
    LabelBox box;
    std::vector<std::uint8_t> row(brick_row_bytes(bricks));
    for (std::uint32_t z = 0; z < bricks.size[2]; ++z) {
        for (std::uint32_t y = 0; y < bricks.size[1]; ++y) {
            brick_row(bricks, label, y, z, row);
            const auto end = row.begin() + bricks.size[0];
            const auto found = std::find(row.begin(), end, of);
            if (found == end) continue;
            const auto x = static_cast<std::uint32_t>(found - row.begin());
            std::uint32_t last = bricks.size[0] - 1;
            while (row[last] != of) --last;
            box.low = {std::min(box.low[0], x), std::min(box.low[1], y), std::min(box.low[2], z)};
            box.high = {std::max(box.high[0], last + 1), std::max(box.high[1], y + 1), z + 1};
        }
    }
    return box;
}

// Squared distances from the axes' points to the voxels whose label is `of` (with `inverse`: is not `of`).
std::vector<float> distances_squared(const BoneBricks& bricks, std::span<const std::uint8_t> label,
                                     std::uint8_t of, bool inverse, const DistanceAxes& axes,
                                     const Progress& progress, double from) {
    const auto& [ax, ay, az] = axes;
    const std::size_t mx = ax.points, my = ay.points;
    std::vector<std::uint8_t> row(brick_row_bytes(bricks));
    std::vector<std::uint32_t> way(ax.high);
    const std::uint32_t ny = ay.high - ay.low, nz = az.high - az.low;
    std::vector<float> rows(mx * ny), planes(mx * my * nz), result(mx * my * az.points),
        best(std::max(my, std::size_t{az.points}));
    for (std::uint32_t z = 0; z < nz; ++z) {
        if (z % 16 == 0) report(progress, from + 0.4 * z / nz, "computing distances to structures");
        for (std::uint32_t y = 0; y < ny; ++y) {
            brick_row(bricks, label, ay.low + y, az.low + z, row);
            std::uint32_t seen = kNoneInRow;
            for (std::uint32_t x = ax.low; x < ax.high; ++x) {
                if ((row[x] == of) != inverse) seen = x;
                way[x] = seen == kNoneInRow ? kNoneInRow : x - seen;
            }
            const std::uint32_t last = seen;
            seen = kNoneInRow;
            for (std::uint32_t x = ax.high; x-- > ax.low;) {
                if (way[x] == 0) seen = x;
                if (seen != kNoneInRow) way[x] = std::min(way[x], seen - x);
            }
            for (std::uint32_t i = 0; i < mx; ++i) {
                const std::uint32_t x = ax.at(i);
                float& value = rows[i * ny + y];
                if (last == kNoneInRow)
                    value = kNowhere;
                else
                    value = gap_squared(x < ax.high ? way[x] : x - last);
            }
        }
        for (std::uint32_t i = 0; i < mx; ++i) {
            ay.reduce(rows.data() + i * ny, best.data());
            for (std::size_t j = 0; j < my; ++j) planes[(i * my + j) * nz + z] = best[j];
        }
    }
    for (std::size_t i = 0; i < mx; ++i) {
        for (std::size_t j = 0; j < my; ++j) {
            az.reduce(planes.data() + (i * my + j) * nz, best.data());
            for (std::uint32_t k = 0; k < az.points; ++k) result[(k * my + j) * mx + i] = best[k];
        }
    }
    return result;
}

}  // namespace

std::uint32_t distance_step(const BoneBricks& bricks) {
    return 4.0 * bricks.voxel_m < 0.5e-3 || bricks.bytes() > std::size_t{1} << 26 ? 4 : 2;
}

BuiltDistances build_distances(const BoneBricks& bricks, std::span<const std::uint8_t> label, std::uint8_t of,
                               const Progress& progress) {
    BuiltDistances built;
    const LabelBox box = box_of(bricks, label, of);
    if (box.high[0] == 0) return built;
    const std::uint32_t step = distance_step(bricks);
    std::array<std::uint32_t, 3> points, low, high;
    for (std::size_t a = 0; a < 3; ++a) {
        points[a] = (bricks.size[a] - 1 + step - 1) / step + 1;
        // One voxel wider: the voxels outside the structure begin there.
        low[a] = box.low[a] > 0 ? box.low[a] - 1 : 0;
        high[a] = std::min(box.high[a] + 1, bricks.size[a]);
    }
    const auto all = [&](std::size_t a) { return DistanceAxis(0, bricks.size[a], step, points[a]); };
    const auto near = [&](std::size_t a) {
        return DistanceAxis(low[a], high[a], step, (high[a] - 1) / step + 1);
    };
    const DistanceAxes outer{all(0), all(1), all(2)}, inner{near(0), near(1), near(2)};
    const std::vector<float> outside = distances_squared(bricks, label, of, false, outer, progress, 0.0);
    const std::vector<float> inside = distances_squared(bricks, label, of, true, inner, progress, 0.5);
    DistanceField& f = built.field;
    f.label = of;
    f.size = points;
    f.spacing_m = step * bricks.voxel_m;
    f.origin_m = bricks.origin_m;
    const std::uint32_t longest = *std::max_element(bricks.size.begin(), bricks.size.end());
    // 32 quanta per voxel, or fewer if the diagonal of the volume would not fit into 16 bits.
    f.quantum_m = bricks.voxel_m * std::max(1.0 / 32.0, 1.8 * longest / 32767.0);
    f.error_m = 0.87 * f.spacing_m + 0.5 * f.quantum_m;
    const double scale = bricks.voxel_m / f.quantum_m;
    built.quanta.resize(outside.size());
    const auto quantized = [scale](double d) {
        return static_cast<std::int16_t>(std::lround(std::clamp(scale * d, -32767.0, 32767.0)));
    };
    std::transform(outside.begin(), outside.end(), built.quanta.begin(),
                   [&](float d) { return quantized(std::sqrt(static_cast<double>(d))); });
    std::size_t from = 0;
    for (std::size_t k = 0; k < inner[2].points; ++k) {
        for (std::size_t j = 0; j < inner[1].points; ++j) {
            for (std::size_t i = 0; i < inner[0].points; ++i, ++from) {
                const std::size_t to =
                    ((inner[2].first + k) * points[1] + inner[1].first + j) * points[0] + inner[0].first + i;
                // If the structure fills the whole volume, this clamps to the deepest value.
                if (inside[from] > 0.0F)
                    built.quanta[to] = quantized(-std::sqrt(static_cast<double>(inside[from])));
            }
        }
    }
    return built;
}

}  // namespace tact
