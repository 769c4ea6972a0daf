#include "ipc/scene/fit/fit_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact {
namespace {

constexpr float kRegionShare = 0.05F;

struct Sums {
    double u = 0.0, v = 0.0, uu = 0.0, vv = 0.0, uv = 0.0;
    std::uint64_t voxels = 0;
};

}  // namespace

Vec3 atom_in_voxels(const DensityGrid& grid, const PlacedStructure& placed, std::size_t atom) {
    const Structure& s = *placed.structure;
    const Vec3 body(static_cast<double>(s.x_m[atom]), static_cast<double>(s.y_m[atom]),
                    static_cast<double>(s.z_m[atom]));
    return (placed.T_model_body * body - grid.origin_m).cwiseQuotient(grid.spacing_m);
}

double map_at(const DensityGrid& grid, const Vec3& at, double background) {
    double value = 0.0;
    const Vec3 low = at.array().floor();
    if (!(low.array() >= -1.0).all() ||
        !(low.x() < grid.size[0] && low.y() < grid.size[1] && low.z() < grid.size[2])) {
        return background;
    }
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        std::array<std::int64_t, 3> voxel{};
        bool inside = true;
        for (int a = 0; a < 3; ++a) {
            const int up = (corner >> a) & 1;
            const double part = at[a] - low[a];
            weight *= up == 1 ? part : 1.0 - part;
            const auto axis = static_cast<std::size_t>(a);
            voxel[axis] = static_cast<std::int64_t>(low[a]) + up;
            inside = inside && voxel[axis] >= 0 && voxel[axis] < static_cast<std::int64_t>(grid.size[axis]);
        }
        value += weight * (inside ? static_cast<double>(grid.at(static_cast<std::uint32_t>(voxel[0]),
                                                                static_cast<std::uint32_t>(voxel[1]),
                                                                static_cast<std::uint32_t>(voxel[2])))
                                  : background);
    }
    return value;
}

RegionCorrelation correlate(const DensityGrid& grid, const VoxelBox& box, std::span<const float> region,
                            std::span<const float> simulated) {
    RegionCorrelation fit;
    const float most = region.empty() ? 0.0F : *std::max_element(region.begin(), region.end());
    if (!(most > 0.0F)) return fit;
    Sums sum;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < box.size[2]; ++z) {
        for (std::uint32_t y = 0; y < box.size[1]; ++y) {
            const float* const row =
                &grid.values[(std::size_t{box.first[2] + z} * grid.size[1] + box.first[1] + y) *
                                 grid.size[0] +
                             box.first[0]];
            for (std::uint32_t x = 0; x < box.size[0]; ++x, ++i) {
                if (!(region[i] > kRegionShare * most)) continue;
                const auto u = static_cast<double>(row[x]), v = static_cast<double>(simulated[i]);
                sum.u += u, sum.v += v;
                sum.uu += u * u, sum.vv += v * v, sum.uv += u * v;
                ++sum.voxels;
            }
        }
    }
    const auto n = static_cast<double>(sum.voxels);
    const double zero = std::sqrt(sum.uu * sum.vv);
    const double varied =
        std::sqrt(std::max(0.0, sum.uu - sum.u * sum.u / n) * std::max(0.0, sum.vv - sum.v * sum.v / n));
    fit.voxels = sum.voxels;
    fit.overlap = sum.uv;
    fit.cc_zero = zero > 0.0 ? sum.uv / zero : 0.0;
    fit.cc_mean = varied > 0.0 ? (sum.uv - sum.u * sum.v / n) / varied : 0.0;
    return fit;
}

}  // namespace tact
