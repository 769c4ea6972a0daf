// The atoms of a file's first model, unchanged, every number checked.
//
// gemmi reads both formats, but only after the atom lines have passed the checks here: gemmi reads an invalid
// coordinate as zero, and an atom at the origin would go unnoticed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

struct AtomRow {
    std::string chain, residue_name, atom_name;
    std::int32_t residue = 0;
    char insertion = ' ';
    char alternate = '\0';  // 0: none
    float occupancy = 1.0F;
    std::uint8_t element = 0;  // atomic number, 0: unknown
    double mass_u = 0.0;
    bool water = false, hydrogen = false, nucleic = false;
    Vec3 position_a = Vec3::Zero();  // ångström, as in the file
};

std::vector<AtomRow> pdb_rows(std::string_view text, const std::string& name);
std::vector<AtomRow> mmcif_rows(std::string_view text, const std::string& name);

// All rows (at least one) as a structure in the frame of its centre of mass. `name` is a path; its last part becomes
// the name of the structure.
Structure structure_of(const std::vector<AtomRow>& rows, const std::string& name);

}  // namespace tact
