// How well placed structures explain a map: the numbers that map-fitting programs show, each defined here.
//
//   u                 map value at a voxel, in the map's unit, nothing subtracted
//   v                 simulated density at the voxel (ipc/scene/density/simulated_map.hpp), unit Z
//   region            voxels with v > 5 % of its largest value (stated beside the number: kFitRegion)
//   cc_zero           correlation about zero, <u,v> / (|u| |v|), over the region
//   cc_mean           correlation about the mean: the same after subtracting the means of u and v there
//   overlap           <u,v>, the sum of u v over the region; map unit times Z
//   mean_density      mean over atoms of the map between the voxels (trilinear; background outside the box)
//   fraction_inside   atoms where that is above the contour
//   clashes           pairs of atoms of two bodies in each other's way (ipc/scene/fit/clashes.hpp)
//
// For one body v is its own density alone, so its region is its own. For all together v is the sum. Each of
// these goes up when a structure explains its part of the map better; only cc_mean is blind to the offset of
// the map's values. Of rigid bodies there is no strain to measure.
//
// Thread    slow (tens of milliseconds); never on the servo thread.
// Fails by  StartupError where the resolution is not positive and finite.
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
    double mean_density = 0.0;        // map unit; every atom counts alike
    double mean_density_sigma = 0.0;  // (mean_density - background) / sigma
    double fraction_inside = 0.0;
    std::uint64_t region_voxels = 0;
    std::uint64_t atoms = 0;
    std::uint64_t clashes = 0;  // of one body: with all others
};

struct FitOfBodies {
    FitMetrics all;
    std::vector<FitMetrics> body;  // in the order of the placed structures
};

struct FitSettings {
    double resolution_m = 0.0;  // > 0
    double contour = 0.0;       // map unit
    // Zero of mean_density_sigma and its unit, as in SceneMeta; sigma 0: mean and deviation of the grid
    // itself.
    double background = 0.0;
    double sigma = 0.0;
};

FitOfBodies fit_of_bodies(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                          const FitSettings& settings);
// Of all bodies together.
FitMetrics fit_metrics(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                       const FitSettings& settings);
inline constexpr char kFitRegion[] = "simulated density above 5 % of its maximum";

}  // namespace tact
