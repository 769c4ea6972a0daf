#include "ipc/assets/fit_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

constexpr float kRegionShare = 0.05F;

Vec3 in_voxels(const DensityGrid& grid, const PlacedStructure& placed, std::size_t atom) {
    const Structure& s = *placed.structure;
    const Vec3 body(static_cast<double>(s.x_m[atom]), static_cast<double>(s.y_m[atom]),
                    static_cast<double>(s.z_m[atom]));
    return (placed.T_model_body * body - grid.origin_m).cwiseQuotient(grid.spacing_m);
}

// Map value between eight voxels; outside the box the background.
double trilinear(const DensityGrid& grid, const Vec3& at, double background) {
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

void correlate(const DensityGrid& grid, const std::vector<float>& simulated, FitMetrics& fit) {
    const float most = simulated.empty() ? 0.0F : *std::max_element(simulated.begin(), simulated.end());
    if (!(most > 0.0F)) return;
    double u = 0.0, v = 0.0, uu = 0.0, vv = 0.0, uv = 0.0;
    for (std::size_t i = 0; i < simulated.size(); ++i) {
        if (!(simulated[i] > kRegionShare * most)) continue;
        const auto a = static_cast<double>(grid.values[i]), b = static_cast<double>(simulated[i]);
        u += a, v += b;
        uu += a * a, vv += b * b, uv += a * b;
        ++fit.region_voxels;
    }
    const auto n = static_cast<double>(fit.region_voxels);
    const double zero = std::sqrt(uu * vv);
    const double varied = std::sqrt(std::max(0.0, uu - u * u / n) * std::max(0.0, vv - v * v / n));
    fit.cc_zero = zero > 0.0 ? uv / zero : 0.0;
    fit.cc_mean = varied > 0.0 ? (uv - u * v / n) / varied : 0.0;
}

}  // namespace

FitMetrics fit_metrics(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                       const FitSettings& settings) {
    if (!(settings.resolution_m > 0.0) || !std::isfinite(settings.resolution_m)) {
        throw StartupError("computing the fit", "the resolution of the map is not known",
                           "state it with --resolution-a");
    }
    FitMetrics fit;
    if (grid.values.size() != grid.count() || grid.values.empty()) return fit;
    double background = settings.background, sigma = settings.sigma;
    if (!(sigma > 0.0)) {
        double sum = 0.0, squares = 0.0;
        for (const float v : grid.values) sum += static_cast<double>(v);
        background = sum / static_cast<double>(grid.values.size());
        for (const float v : grid.values) squares += std::pow(static_cast<double>(v) - background, 2.0);
        sigma = std::sqrt(squares / static_cast<double>(grid.values.size()));
    }
    correlate(grid, simulated_map(grid, placed, settings.resolution_m), fit);
    double mass = 0.0, inside = 0.0, atoms = 0.0;
    for (const PlacedStructure& p : placed) {
        for (std::size_t i = 0; i < p.structure->size(); ++i) {
            const double m = static_cast<double>(p.structure->mass_fraction[i]) * p.structure->mass_u;
            const double value = trilinear(grid, in_voxels(grid, p, i), background);
            fit.mean_density_sigma += m * (value - background);
            inside += value > settings.contour ? 1.0 : 0.0;
            mass += m;
            atoms += 1.0;
        }
    }
    if (mass > 0.0 && sigma > 0.0) fit.mean_density_sigma /= mass * sigma;
    if (atoms > 0.0) fit.fraction_inside = inside / atoms;
    return fit;
}

}  // namespace tact
