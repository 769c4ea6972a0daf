// Atomic structures from PDB (.pdb .ent) and mmCIF (.cif .mmcif) files, each also as .gz.
//
// Kept     the first model; heavy atoms of polymers, ligands and ions. Dropped: hydrogens, waters, and of
//          alternate locations all but the one with the highest occupancy (the first among equals).
// Frame    see ipc/scene/density/structure.hpp: body frame about the centre of mass, metres.
// Fails by StartupError naming the file, the line or row, the reason and the fix.
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

// The same from bytes in memory (not packed), for tests and fuzzing. `ending` decides the format.
ImportedStructure import_structure_bytes(std::string_view bytes, const std::string& name,
                                         const std::string& ending);

}  // namespace tact
