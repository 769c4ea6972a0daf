// Springs between the residues of a structure, as in an elastic network model.
//
// Stiffness of a spring  (kNeighbourM / length)^6, so that neighbours along the chain hold together much more than others (K. Hinsen
//           et al., "Harmonicity in slow protein dynamics", Chemical Physics 261, 2000)
// Springs   between all nodes up to `cutoff_m`, and from each node to its kNearest nearest ones. Parts that no spring joins are joined
//           by their nearest nodes, so that no part moves freely
// Thread    any; allocates
#pragma once

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

// Sorted by a, then b.
[[nodiscard]] std::vector<Spring> make_springs(const std::vector<Vec3>& nodes_m, double cutoff_m);

}  // namespace tact
