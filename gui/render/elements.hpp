// Colour and size of the chemical elements, by atomic number; 0 and what is above the table: not known.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

using Rgb8 = std::array<std::uint8_t, 3>;

// As Jmol has them, which other viewers follow. Carbon is grey here; who draws several chains colours it by
// chain.
[[nodiscard]] Rgb8 element_colour(std::uint8_t atomic_number);
// Okabe-Ito, told apart by colour-blind people too; without black, which is not seen on a dark ground.
[[nodiscard]] Rgb8 chain_colour(std::size_t chain);
// Van der Waals radius (Bondi 1964, Mantina 2009), ångström; 2 where not known.
[[nodiscard]] float vdw_radius_a(std::uint8_t atomic_number);
// Covalent radius (Cordero 2008), ångström. 0: forms no bond that a distance would tell (noble gases, and the
// ions of groups 1 and 2, which sit among many atoms as near as a bond).
[[nodiscard]] float covalent_radius_a(std::uint8_t atomic_number);

}  // namespace tact
