// The atoms of a file bent along the normal modes of its structure, with the bonds of the file.
//
// Bending   every atom moves with its residue; atoms of other residues (waters) with the nearest one
// Bonds     modes are straight lines, so a lobe that turns far grows, and bonds between residues change. Distances over one and two bonds
//           are therefore brought back to those of the file (Gauss-Seidel, as in SHAKE: J.-P. Ryckaert et al., J. Comput. Phys. 23, 1977),
//           until no bond differs by more than kBondMost. Bonds: ipc/scene/density/bonds.hpp
// Unit      ångström, frame of the file
// Thread    any; allocates; up to seconds for very large files
#pragma once

#include <span>
#include <vector>

#include "ipc/scene/density/normal_modes.hpp"
#include "prep/export/file_atoms.hpp"

namespace tact {

inline constexpr double kBondMost = 0.002;

struct BentPlaces {
    std::vector<Vec3> at_a;  // of each atom of the file
    double rmsd_a = 0.0;     // from the places in the file, over all atoms
    std::size_t bonds = 0;
    double bond_most = 0.0;        // largest relative change of the length of a bond
    double bond_most_modes = 0.0;  // the same before bonds were brought back
};

// Throws StartupError if no atom of the file is in a residue of the structure.
[[nodiscard]] BentPlaces bent_places(const std::vector<FileAtom>& atoms, const Structure& structure,
                                     const NormalModes& modes, std::span<const float> amplitude_m);

}  // namespace tact
