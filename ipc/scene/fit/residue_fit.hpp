// Fit of each residue of a placed structure to a map, for what a single number of the whole structure hides: a loop or a domain
// that is wrong.
//
//   density_sigma   mean of the map at the residue's atoms (trilinear), (value - background) / sigma;
//                   0 if sigma is not positive
//   correlation     about the mean, of the map with the simulated density of ALL placed structures, over the voxels where the
//                   simulated density of a window of residues along the chain exceeds 5 % of its largest value. Between -1 and 1;
//                   1 where the map is what the structures predict there, whatever its scale and offset
//
// Window    residues of the same chain whose numbers differ from the residue's by at most half of the window: at a coarse
//           resolution one residue is less than a voxel's neighbourhood, and its correlation only noise
// Residue   atoms that follow each other in the file with the same chain and number; insertion codes are not told apart
// Thread    slow (seconds for thousands of residues); never on the servo thread
// Errors    StartupError if the resolution is not positive and finite
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ipc/scene/fit/fit_metrics.hpp"

namespace tact {

struct ResidueFit {
    std::uint16_t chain = 0;  // index into chain_names
    std::int32_t residue = 0;
    std::size_t first_atom = 0, atoms = 0;
    double density_sigma = 0.0;
    std::optional<double> correlation;  // none: off the map, or fewer than eight voxels
};

// Of the first of the placed structures. window: an odd number of residues.
std::vector<ResidueFit> residue_fit(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                                    const FitSettings& settings, int window);

}  // namespace tact
