// Colour and size of chemical elements by atomic number; 0 and numbers above the table: unknown.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

using Rgb8 = std::array<std::uint8_t, 3>;

// Jmol colours, which other viewers follow. Carbon is grey; callers that draw several chains colour it by chain.
[[nodiscard]] Rgb8 element_colour(std::uint8_t atomic_number);
// Okabe-Ito palette, safe for colour-blind users; without black, which is invisible on a dark background.
[[nodiscard]] Rgb8 chain_colour(std::size_t chain);
// Van der Waals radius (Bondi 1964, Mantina 2009), ångström; 2 if unknown.
[[nodiscard]] float vdw_radius_a(std::uint8_t atomic_number);
}  // namespace tact
