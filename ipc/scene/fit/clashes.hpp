// Number of overlapping atom pairs of placed structures: the clash count of a fit panel.
//
// Clash     a pair of atoms of two different structures whose van der Waals spheres overlap by 0.6 A or
//           more,
//               r_i + r_j - |x_i - x_j| - h >= 0.6 A,
//           h = 0.4 A if both are N, O or S (they may share a hydrogen), as in map-fitting and model-building
//           programs by default. Radii of Bondi (1964); 1.7 A for elements that are unknown or not in his
//           list. Atoms as imported, that is without hydrogens. Pairs within one structure do not count.
//           Where a chain is cut into two structures, formerly bonded atoms count too.
// Reference the sum over all pairs, in tests/unit/scene_clashes_test.cpp, gives the same numbers
// Thread    slow (tens of milliseconds for tens of thousands of atoms); never on the servo thread
// Errors    none: atoms at NaN positions clash with nothing
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/density/simulated_map.hpp"

namespace tact {

inline constexpr double kClashOverlapM = 0.6e-10, kClashShareM = 0.4e-10;
inline constexpr char kClashDefinition[] =
    "atom pairs of two structures whose van der Waals spheres overlap by 0.6 Å or more (N, O, S pairs: 1.0 "
    "Å)";

struct ClashCounts {
    std::uint64_t pairs = 0;
    std::vector<std::uint64_t> pairs_of;  // by structure, in the given order; each pair counts for both
    std::vector<std::uint32_t> atoms_of;  // with a clash
};

[[nodiscard]] ClashCounts count_clashes(std::span<const PlacedStructure> placed);

// Metres. element: atomic number, 0: unknown.
[[nodiscard]] double van_der_waals_radius_m(std::uint8_t element);

}  // namespace tact
