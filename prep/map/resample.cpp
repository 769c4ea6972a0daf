#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "prep/map/formats.hpp"

namespace tact::map_format {
namespace {

double mean_of_faces(const SkewGrid& g) {
    double sum = 0.0;
    std::size_t count = 0, i = 0;
    for (std::uint32_t z = 0; z < g.size[2]; ++z) {
        for (std::uint32_t y = 0; y < g.size[1]; ++y) {
            for (std::uint32_t x = 0; x < g.size[0]; ++x, ++i) {
                if (x == 0 || y == 0 || z == 0 || x + 1 == g.size[0] || y + 1 == g.size[1] ||
                    z + 1 == g.size[2]) {
                    sum += static_cast<double>(g.values[i]);
                    ++count;
                }
            }
        }
    }
    return sum / static_cast<double>(count);
}

// Crystal cells need less than eight times the voxels. The limit keeps a small malicious file from exhausting memory.
constexpr double kGrowthMax = 64.0;

}  // namespace

DensityGrid resample(const SkewGrid& skew, const std::string& name) {
    // Bounding box of the eight corners.
    Vec3 low = Vec3::Constant(1e300), high = -low;
    const Vec3 last(skew.size[0] - 1.0, skew.size[1] - 1.0, skew.size[2] - 1.0);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 index((corner & 1) != 0 ? last.x() : 0.0, (corner & 2) != 0 ? last.y() : 0.0,
                         (corner & 4) != 0 ? last.z() : 0.0);
        const Vec3 p = skew.origin_m + skew.step_m * index;
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double step_m = skew.step_m.colwise().norm().minCoeff();
    DensityGrid out;
    out.origin_m = low;
    out.spacing_m = Vec3::Constant(step_m);
    double voxels = 1.0;
    for (int a = 0; a < 3; ++a) {
        const double n = std::floor((high[a] - low[a]) / step_m + 1e-9) + 1.0;
        voxels *= n;
        out.size[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(std::min(n, 1e9));
    }
    const double voxels_max =
        std::min(static_cast<double>(kMapVoxelsMax), kGrowthMax * static_cast<double>(skew.values.size()));
    if (!(voxels <= voxels_max)) {
        throw StartupError("read map " + name,
                           "the skew cell would need " + std::to_string(voxels) +
                               " voxels on axes at right angles, more than " + std::to_string(voxels_max),
                           "resample the map to larger voxels and cell angles of 90 degrees");
    }
    const double outside = mean_of_faces(skew);
    const Eigen::Matrix3d to_index = skew.step_m.inverse();
    const auto value = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return static_cast<double>(skew.values[(std::size_t{z} * skew.size[1] + y) * skew.size[0] + x]);
    };
    out.values.reserve(out.count());
    for (std::uint32_t z = 0; z < out.size[2]; ++z) {
        for (std::uint32_t y = 0; y < out.size[1]; ++y) {
            for (std::uint32_t x = 0; x < out.size[0]; ++x) {
                const Vec3 index = to_index * (low + step_m * Vec3(x, y, z) - skew.origin_m);
                // Rounding may put a corner of the box outside the grid.
                if ((index.array() < -1e-6).any() || (index.array() > last.array() + 1e-6).any()) {
                    out.values.push_back(static_cast<float>(outside));
                    continue;
                }
                std::uint32_t i[3];
                double t[3];
                for (int a = 0; a < 3; ++a) {
                    const double clamped = std::clamp(index[a], 0.0, last[a]);
                    i[a] = std::min(static_cast<std::uint32_t>(clamped),
                                    skew.size[static_cast<std::size_t>(a)] - 2);
                    t[a] = clamped - i[a];
                }
                double sum = 0.0;
                for (std::uint32_t c = 0; c < 8; ++c) {
                    const std::uint32_t dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
                    sum += (dx != 0 ? t[0] : 1.0 - t[0]) * (dy != 0 ? t[1] : 1.0 - t[1]) *
                           (dz != 0 ? t[2] : 1.0 - t[2]) * value(i[0] + dx, i[1] + dy, i[2] + dz);
                }
                out.values.push_back(static_cast<float>(sum));
            }
        }
    }
    return out;
}

}  // namespace tact::map_format
