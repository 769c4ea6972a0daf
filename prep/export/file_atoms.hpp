// All atoms of a structure file with all properties that PDB and mmCIF state; unlike at import, none is dropped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prep/export/atom_move.hpp"

namespace tact {

struct FileAtom {
    bool het = false;
    int model = 1;
    std::string name, residue_name, chain, element;  // without spaces
    std::string residue;                             // sequence number
    char insertion = ' ', alternate = ' ';
    Vec3 place_a = Vec3::Zero();
    double occupancy = 1.0, b_iso = 0.0;
    std::string charge;  // as in the file
    std::optional<Adp> adp_u;
    bool ends_chain = false;  // a TER followed
};

std::vector<FileAtom> pdb_atoms(std::string_view text, const std::string& name);
std::vector<FileAtom> mmcif_atoms(std::string_view text, const std::string& name);

// Throws StartupError with file, place and text if the text is not a finite number of at most 1e5 in size.
double file_number(std::string_view text, const char* what, const std::string& name,
                   const std::string& where);

}  // namespace tact
