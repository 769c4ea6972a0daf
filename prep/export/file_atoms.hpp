// All atoms of a structure file with all that PDB and mmCIF say of each: nothing is dropped, unlike at
// import.
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
    std::string name, residue_name, chain, element;  // without blanks
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

// Throws StartupError naming the file, the place and the text where it is no finite number up to 1e5.
double file_number(std::string_view text, const char* what, const std::string& name,
                   const std::string& where);

}  // namespace tact
