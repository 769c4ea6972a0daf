// Which atoms of a structure are bonded, told by their distance: nearer than the sum of the covalent radii
// and 0.45 ångström (as Jmol and Open Babel do), and not nearer than 0.4.
//
// Between  atoms of one chain whose residue numbers differ by at most one, and sulphurs anywhere.
// Bounds   time and memory are linear in the atoms, whatever the file says: three cells of the search grid
//          give their first kRowAtomsMax atoms, an atom starts at most kBondsOfAtomMax bonds.
// Thread   any.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/scene/density/structure.hpp"

namespace tact {

using Bond = std::array<std::uint32_t, 2>;  // atoms, the lower first

inline constexpr double kBondSlackA = 0.45, kBondMinA = 0.4;
inline constexpr std::size_t kRowAtomsMax = 192;  // crystals hold thirty in three cells
inline constexpr std::size_t kBondsOfAtomMax = 8;

// Sorted, each once.
[[nodiscard]] std::vector<Bond> find_bonds(const Structure& structure);
// Whether the rule above joins two different atoms.
[[nodiscard]] bool bonded(const Structure& structure, std::uint32_t i, std::uint32_t j);

}  // namespace tact
