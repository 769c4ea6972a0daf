// Springs between the residues of a structure, as in an elastic network model.
//
// Stiffness of a spring  (kNeighbourM / length)^6, so that neighbours along the chain hold together much more than others (K. Hinsen
//           et al., "Harmonicity in slow protein dynamics", Chemical Physics 261, 2000)
// Chain     nodes that follow each other along a chain hold together at least as kChain says, whatever their distance: peptide bonds do
//           not stretch, and a chain does not fold as easily as two residues slide past each other
// Springs   between all nodes up to `cutoff_m`, and from each node to its kNearest nearest ones. Parts that no spring joins are joined
//           by their nearest nodes, so that no part moves freely
// Thread    any; allocates
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct Spring {
    std::uint32_t a = 0, b = 0;  // nodes, a < b
    double stiffness = 0.0;
};

inline constexpr double kNeighbourM = 7e-10;
inline constexpr std::size_t kNearest = 8;
// For the next node of the chain, the second next, and so on; nodes farther apart than kChainMostM are a gap.
inline constexpr std::array kChain{200.0, 60.0, 20.0};
inline constexpr double kChainMostM = 8e-10;

// chain: of each node; nodes of a chain in their order. scale: of all lengths, for nodes that stand for several residues. Sorted by a, then
// b.
[[nodiscard]] std::vector<Spring> make_springs(const std::vector<Vec3>& nodes_m,
                                               const std::vector<std::uint16_t>& chain, double cutoff_m,
                                               double scale);

}  // namespace tact
