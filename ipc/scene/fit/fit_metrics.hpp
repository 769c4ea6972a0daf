// Fit of placed structures to a map: the usual metrics of map-fitting programs, each defined here.
//
//   u                 map value at a voxel, in the map's unit, nothing subtracted
//   v                 simulated density at the voxel (ipc/scene/density/simulated_map.hpp), unit Z
//   region            voxels with v > 5 % of its largest value (shown with the number: kFitRegion)
//   cc_zero           correlation about zero, <u,v> / (|u| |v|), over the region
//   cc_mean           correlation about the mean: the same after subtracting the means of u and v there
//   overlap           <u,v>, the sum of u v over the region; map unit times Z
//   mean_density      mean over atoms of the map between the voxels (trilinear; background outside the box)
//   fraction_inside   fraction of atoms at which that value is above the contour
//   clashes           overlapping atom pairs of two bodies (ipc/scene/fit/clashes.hpp)
//
// For one body, v is its own density alone, so the region is its own. For all together, v is the sum. Each
// metric rises when a structure explains its part of the map better; only cc_mean does not depend on the
// offset of the map's values. Rigid bodies have no strain to measure.
//
// Thread    slow (tens of milliseconds); never on the servo thread
// Errors    StartupError if the resolution is not positive and finite
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/scene/fit/clashes.hpp"

namespace tact {

struct FitMetrics {
    double cc_zero = 0.0;
    double cc_mean = 0.0;
    double overlap = 0.0;
    double mean_density = 0.0;        // map unit; every atom has the same weight
    double mean_density_sigma = 0.0;  // (mean_density - background) / sigma
    double fraction_inside = 0.0;
    std::uint64_t region_voxels = 0;
    std::uint64_t atoms = 0;
    std::uint64_t clashes = 0;  // for one body: with all others
};

struct FitOfBodies {
    FitMetrics all;
    std::vector<FitMetrics> body;  // in the order of the placed structures
};

struct FitSettings {
    double resolution_m = 0.0;  // > 0
    double contour = 0.0;       // map unit
    // Zero and unit of mean_density_sigma, as in SceneMeta; sigma 0: mean and deviation of the grid itself.
    double background = 0.0;
    double sigma = 0.0;
};

FitOfBodies fit_of_bodies(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                          const FitSettings& settings);
// For all bodies together.
FitMetrics fit_metrics(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                       const FitSettings& settings);
inline constexpr char kFitRegion[] = "simulated density above 5 % of its maximum";

}  // namespace tact
