// Helices and strands of a protein, from its C-alpha atoms alone.
//
// Method   P-SEA: G. Labesse, N. Colloc'h, J. Pothier, J.-P. Mornon, Comput. Appl. Biosci. 13 (1997) 291: distances, angles and
//          dihedrals of successive C-alpha atoms. A helix has at least five residues, a strand at least three, and those of
//          fewer than five a neighbour strand. No hydrogen bonds are needed, so models without oxygens have ribbons too
// Thread   any
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace tact {

enum class Fold : std::uint8_t { coil, helix, strand };

// The C-alpha atoms of each chain without gaps, ångström. One entry per atom.
[[nodiscard]] std::vector<std::vector<Fold>> folds_of(
    const std::vector<std::vector<Eigen::Vector3f>>& chains_a);

}  // namespace tact
