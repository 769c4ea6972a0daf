#include "ipc/scene/fit/fit_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/scene/fit/fit_sums.hpp"

namespace tact {

namespace {

// Adds a box of values to the values of the whole grid.
void add_box(const DensityGrid& grid, const VoxelBox& box, std::span<const float> part,
             std::span<float> whole) {
    for (std::uint32_t z = 0; z < box.size[2]; ++z) {
        for (std::uint32_t y = 0; y < box.size[1]; ++y) {
            const float* const from = &part[(std::size_t{z} * box.size[1] + y) * box.size[0]];
            float* const to =
                &whole[(std::size_t{box.first[2] + z} * grid.size[1] + box.first[1] + y) * grid.size[0] +
                       box.first[0]];
            for (std::uint32_t x = 0; x < box.size[0]; ++x) to[x] += from[x];
        }
    }
}

// Sums over atoms, before division.
void look_at_atoms(const DensityGrid& grid, const PlacedStructure& placed, double background, double contour,
                   FitMetrics& fit) {
    for (std::size_t i = 0; i < placed.structure->size(); ++i) {
        const double value = map_at(grid, atom_in_voxels(grid, placed, i), background);
        fit.mean_density += value;
        fit.fraction_inside += value > contour ? 1.0 : 0.0;
    }
    fit.atoms = placed.structure->size();
}

void divide_by_atoms(FitMetrics& fit, double background, double sigma) {
    if (fit.atoms == 0) return;
    const auto n = static_cast<double>(fit.atoms);
    fit.mean_density /= n;
    fit.fraction_inside /= n;
    if (sigma > 0.0) fit.mean_density_sigma = (fit.mean_density - background) / sigma;
}

void add_correlation(const RegionCorrelation& c, FitMetrics& fit) {
    fit.cc_zero = c.cc_zero, fit.cc_mean = c.cc_mean;
    fit.overlap = c.overlap, fit.region_voxels = c.voxels;
}

}  // namespace

FitOfBodies fit_of_bodies(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                          const FitSettings& settings) {
    if (!(settings.resolution_m > 0.0) || !std::isfinite(settings.resolution_m)) {
        throw StartupError("computing the fit", "the resolution of the map is unknown",
                           "set it with --resolution-a");
    }
    FitOfBodies fit;
    fit.body.resize(placed.size());
    if (grid.values.size() != grid.count() || grid.values.empty()) return fit;
    double background = settings.background, sigma = settings.sigma;
    if (!(sigma > 0.0)) {
        double sum = 0.0, squares = 0.0;
        for (const float v : grid.values) sum += static_cast<double>(v);
        background = sum / static_cast<double>(grid.values.size());
        for (const float v : grid.values) squares += std::pow(static_cast<double>(v) - background, 2.0);
        sigma = std::sqrt(squares / static_cast<double>(grid.values.size()));
    }
    // All together: in the smallest box that contains all of them.
    const VoxelBox together = reached_box(grid, placed, settings.resolution_m);
    DensityGrid frame;  // geometry of that box, without values
    frame.size = together.size;
    std::vector<float> sum(placed.size() > 1 ? together.count() : 0, 0.0F), own;
    for (std::size_t b = 0; b < placed.size(); ++b) {
        VoxelBox box = reached_box(grid, placed.subspan(b, 1), settings.resolution_m);
        own.assign(box.count(), 0.0F);
        add_simulated(grid, placed[b], settings.resolution_m, 1.0F, box, own);
        add_correlation(correlate(grid, box, own, own), fit.body[b]);
        look_at_atoms(grid, placed[b], background, settings.contour, fit.body[b]);
        fit.all.mean_density += fit.body[b].mean_density;
        fit.all.fraction_inside += fit.body[b].fraction_inside;
        fit.all.atoms += fit.body[b].atoms;
        divide_by_atoms(fit.body[b], background, sigma);
        if (placed.size() < 2 || own.empty()) continue;
        for (std::size_t a = 0; a < 3; ++a) box.first[a] -= together.first[a];
        add_box(frame, box, own, sum);
    }
    divide_by_atoms(fit.all, background, sigma);
    if (placed.size() == 1) fit.all = fit.body.front();
    if (placed.size() > 1) add_correlation(correlate(grid, together, sum, sum), fit.all);
    const ClashCounts clashes = count_clashes(placed);
    fit.all.clashes = clashes.pairs;
    for (std::size_t b = 0; b < placed.size(); ++b) fit.body[b].clashes = clashes.pairs_of[b];
    return fit;
}

FitMetrics fit_metrics(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                       const FitSettings& settings) {
    return fit_of_bodies(grid, placed, settings).all;
}

}  // namespace tact
