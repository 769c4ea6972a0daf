// How well placed structures explain a map: the correlations that map-fitting programs show.
//
// Simulated map   Gaussians on every atom, weight proportional to its atomic number Z (mass where Z is
//                 unknown), sigma = 0.225 * resolution, sampled on the map's own grid.
// Region          voxels whose simulated density is above 5 % of its largest value (stated beside the
// number). cc_zero         <u,v> / (|u| |v|);  cc_mean  the same after subtracting the means over the region.
// Thread          slow (tens of milliseconds); never on the servo thread.
// Fails by        StartupError where the resolution is not positive and finite.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ipc/assets/simulated_map.hpp"

namespace tact {

struct FitMetrics {
    double cc_zero = 0.0;
    double cc_mean = 0.0;
    double mean_density_sigma = 0.0;  // over all atoms, mass weighted, above background
    double fraction_inside = 0.0;     // atoms above the contour level
    std::uint64_t region_voxels = 0;
};

struct FitSettings {
    double resolution_m = 0.0;  // > 0
    double contour = 0.0;       // map unit
    // Zero of mean_density_sigma and its unit, as in SceneMeta; sigma 0: mean and deviation of the grid
    // itself.
    double background = 0.0;
    double sigma = 0.0;
};

FitMetrics fit_metrics(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                       const FitSettings& settings);
inline constexpr char kFitRegion[] = "simulated density above 5 % of its maximum";

}  // namespace tact
