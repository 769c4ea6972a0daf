// A structure and a map that belong together, made in code: a ring of six and its 12 Å map.
//
// Subunit   about 160 residues of backbone: a large lobe of four helices, a small lobe of four aside and
//           above it, one long arm towards the axis, and loops between them. It has no symmetry, so its own
//           map tells its rotation; the six neighbours touch lightly, so the map keeps them apart.
// Map       Gaussians (sigma 0.225 x resolution) on all atoms of all six, plus noise of 1 % of the largest
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
    std::vector<Structure> subunits;  // chains A to F, each with its true place in the map as its home
    double resolution_m = 0.0;
};

SyntheticRing make_ring(std::uint64_t seed = 1);

}  // namespace tact
