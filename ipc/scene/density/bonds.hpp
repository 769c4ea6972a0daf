// Finds the bonds of a structure by distance: below the sum of the covalent radii plus 0.45 ångström (as in Jmol and
// Open Babel), and not below 0.4.
//
// Between  atoms of one chain whose residue numbers differ by at most one, and sulphurs anywhere.
// Bounds   time and memory are linear in the atoms for any file: three cells of the search grid contribute
//          their first kRowAtomsMax atoms, and an atom starts at most kBondsOfAtomMax bonds.
// Thread   any.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/scene/density/structure.hpp"

namespace tact {

using Bond = std::array<std::uint32_t, 2>;  // atoms, the lower first

inline constexpr double kBondSlackA = 0.45, kBondMinA = 0.4;
inline constexpr std::size_t kRowAtomsMax = 192;  // crystals have thirty in three cells
inline constexpr std::size_t kBondsOfAtomMax = 8;

// Covalent radius (Cordero 2008), ångström. 0: distance tells no bond (noble gases, and ions of groups 1 and 2, which
// have many atoms at bonding distance).
[[nodiscard]] float covalent_radius_a(std::uint8_t atomic_number);

// Sorted, without duplicates.
[[nodiscard]] std::vector<Bond> find_bonds(const Structure& structure);
// True if the rule above joins these two atoms.
[[nodiscard]] bool bonded(const Structure& structure, std::uint32_t i, std::uint32_t j);

}  // namespace tact
