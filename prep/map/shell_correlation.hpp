// Resolution of a map from its two half-maps: the Fourier shell correlation (Harauz and van Heel 1986) falls below 0.143
// (Rosenthal and Henderson 2003).
//
//   FSC(shell) = sum Re(A conj B) / sqrt(sum |A|^2 sum |B|^2),   A, B: transforms of the half-maps less their means
//
// Shells    one wave of the longest side of the box wide, to the Nyquist frequency of the coarsest axis
// Mask      hides the solvent, but its own edge correlates the two halves. What it adds is measured on the same halves with
//           the phases beyond the shell where the unmasked curve falls below 0.8 replaced by random ones, and taken out:
//           (FSC_masked - FSC_random) / (1 - FSC_random)  (Chen et al. 2013). Repeats: the random numbers have a fixed seed.
// Thread    slow (seconds for 300^3 voxels)
// Errors    StartupError: the grids differ, or a half-map is constant
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

inline constexpr double kFscThreshold = 0.143;

struct Shell {
    double frequency_per_m = 0.0;  // middle of the shell
    double correlation = 0.0;      // corrected for the mask, if there is one
    std::size_t waves = 0;         // independent ones: half of those in the shell
};

struct ShellCorrelation {
    std::vector<Shell> shells;           // without the shell of the mean
    std::optional<double> resolution_m;  // none: never below the threshold, so finer than the voxels show
    double finest_m = 0.0;               // what the voxels can show: two of the coarsest
};

// mask: null, or of the same grid, 0 to 1.
ShellCorrelation shell_correlation(const DensityGrid& half_1, const DensityGrid& half_2,
                                   const DensityGrid* mask);

}  // namespace tact
