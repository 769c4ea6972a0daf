// A synthetic structure and its map: a ring of six subunits and its 12 Å map.
//
// Subunit   about 160 residues of backbone: a large lobe of four helices, a small lobe of four beside and above it, one
//           long arm towards the axis, and loops between them. It has no symmetry, so its map determines its rotation;
//           the six neighbours touch slightly, so the map separates them.
// Map       Gaussians (sigma 0.225 x resolution) on all atoms of the six subunits, plus noise of 1 % of the largest
//           value.
// Repeats   the same seed gives the same bytes.
// Frame     model, metres; the axis of the ring is z.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

struct SyntheticRing {
    DensityGrid grid;
    std::vector<Structure> subunits;  // chains A to F, each with its true position in the map as home
    double resolution_m = 0.0;
};

SyntheticRing make_ring(std::uint64_t seed = 1);

}  // namespace tact
