// Normal modes of a structure by an elastic network of its residues: H u = lambda M u for the smallest lambda that are not rigid motions.
//
// Network   one node per residue with a backbone atom (trace), at its centre of mass with its mass; above kNodesMax one per several
//           residues of a chain, and displacements in between are interpolated. Springs: spring_network.hpp
// Others    residues without a backbone atom (ligands, waters) move with the nearest three nodes
// Solver    Spectra, shift and invert; the same input gives the same modes
// Source    A. R. Atilgan et al., "Anisotropy of fluctuation dynamics of proteins with an elastic network model", Biophysical Journal 80, 2001
// Small     with fewer than kNodesMin nodes there are no modes
// Fails by  StartupError: the solver did not converge; Cancelled by `progress`
// Thread    any; allocates; up to a minute for very large structures
#pragma once

#include <cstdint>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr std::size_t kNodesMin = 16, kNodesMax = 2500;

// count: 1 to kModesMax.
[[nodiscard]] NormalModes elastic_modes(const Structure& structure, std::uint32_t count,
                                        const Progress& progress = {});

}  // namespace tact
