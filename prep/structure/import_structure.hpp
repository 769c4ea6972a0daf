// Reads atomic structures: PDB (.pdb .ent) and mmCIF (.cif .mmcif) files, each also as .gz.
//
// Kept     the first model; heavy atoms of polymers, ligands and ions. Dropped: hydrogens, waters, and all alternate
//          locations except the one of highest occupancy (the first among equals).
// Frame    see ipc/scene/density/structure.hpp: body frame about the centre of mass, metres.
// Fails by StartupError with file, line or row, reason and fix.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "ipc/scene/density/structure.hpp"

namespace tact {

struct ImportedStructure {
    Structure structure;
    std::string summary;  // "3855 atoms in 1 chain (A), 525 on the backbone; dropped 12 hydrogens, ..."
};

ImportedStructure import_structure(const std::filesystem::path& path);

// The same from uncompressed bytes in memory, for tests and fuzzing. `ending` selects the format.
ImportedStructure import_structure_bytes(std::string_view bytes, const std::string& name,
                                         const std::string& ending);

}  // namespace tact
