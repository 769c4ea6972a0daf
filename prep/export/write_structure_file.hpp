// Writes a structure file with moved atoms: the original text with new coordinates, or a new file.
//
// Kept      everything that stays valid: names, sequence, secondary structure, waters, hydrogens, all models.
// Left out  records that hold only for the original coordinates: cell, symmetry, origin and scale matrices,
//           assemblies; of PDB files also MASTER, whose counts would be wrong, and the fit of an earlier
//           save.
// Bent      with `bent_a` an atom's place in the file is replaced by that in the list (bent_places.hpp), one per atom of the file
// Precision three digits of an ångström; ADPs four digits of an ångström squared.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "prep/export/atom_move.hpp"
#include "prep/export/file_atoms.hpp"

namespace tact {

using Remarks = std::vector<std::pair<std::string, std::string>>;  // key (of _tact_fit. in mmCIF) and value

// Empty if a coordinate does not fit the columns of PDB.
std::optional<std::string> moved_pdb(std::string_view text, const std::string& name, const AtomMove& move,
                                     const Remarks& remarks, std::span<const Vec3> bent_a = {});
std::string moved_mmcif(std::string_view text, const std::string& name, const AtomMove& move,
                        const Remarks& remarks, std::span<const Vec3> bent_a = {});

// Empty if there are too many atoms (99999 with the TER lines), a chain id is longer than one letter, or a coordinate
// does not fit.
std::optional<std::string> new_pdb(const std::vector<FileAtom>& atoms, const Remarks& remarks);
std::string new_mmcif(const std::vector<FileAtom>& atoms, const std::string& name, const Remarks& remarks);

}  // namespace tact
