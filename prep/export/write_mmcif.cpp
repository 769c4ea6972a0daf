#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/error.hpp"
#include "prep/cif/cif_document.hpp"
#include "prep/export/write_structure_file.hpp"

namespace tact {
namespace {

// Categories that hold only for the original coordinates.
const std::vector<std::string> kUntrueCategories{"_cell.",
                                                 "_symmetry.",
                                                 "_symmetry_equiv.",
                                                 "_space_group.",
                                                 "_space_group_symop.",
                                                 "_atom_sites.",
                                                 "_database_PDB_matrix.",
                                                 "_pdbx_struct_assembly.",
                                                 "_pdbx_struct_assembly_gen.",
                                                 "_pdbx_struct_assembly_prop.",
                                                 "_pdbx_struct_oper_list.",
                                                 "_struct_ncs_oper.",
                                                 "_tact_fit."};

std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

void put_remarks(CifDocument& document, std::size_t block, const Remarks& remarks) {
    for (const auto& [key, value] : remarks) document.set_pair(block, "_tact_fit." + key, value);
}

// Rotates U[1][1] … or B[1][1] …, whichever columns the table has; keeps "." and "?".
void turn_adps(CifTable table, std::size_t first, const AtomMove& move, const std::string& name, int digits) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
        Adp u{};
        bool all = true;
        for (std::size_t k = 0; k < 6; ++k) {
            all = all && table.known(row, first + k);
            if (all) u[k] = file_number(table.raw(row, first + k), "ADP", name, "an ADP");
        }
        if (!all) continue;
        u = move.turned(u);
        for (std::size_t k = 0; k < 6; ++k) table.set(row, first + k, fixed(u[k], digits));
    }
}

}  // namespace

std::string moved_mmcif(std::string_view text, const std::string& name, const AtomMove& move,
                        const Remarks& remarks, std::span<const Vec3> bent_a) {
    (void)mmcif_atoms(text, name);  // checks that the text is mmCIF and every number is valid
    CifDocument document = CifDocument::read(text, name);
    for (std::size_t block = 0; block < document.blocks(); ++block) {
        CifTable places = document.table(
            block, "_atom_site.", {"Cartn_x", "Cartn_y", "Cartn_z", "?fract_x", "?fract_y", "?fract_z"});
        if (places.rows() == 0) continue;
        for (std::size_t row = 0; row < places.rows(); ++row) {
            const auto number = [&](std::size_t k) {
                return file_number(places.raw(row, k), "a coordinate", name, "atom_site");
            };
            const Vec3 p = move * (bent_a.empty() ? Vec3(number(0), number(1), number(2)) : bent_a[row]);
            for (std::size_t k = 0; k < 3; ++k) {
                places.set(row, k, fixed(p[static_cast<int>(k)], 3));
                if (places.has(3 + k)) places.set(row, 3 + k, "?");  // fractional: the cell is removed
            }
        }
        for (const std::string letter : {"U", "B"}) {
            std::vector<std::string> own, beside;
            for (const char* const k : {"[1][1]", "[2][2]", "[3][3]", "[1][2]", "[1][3]", "[2][3]"}) {
                own.push_back(letter + k);
                beside.push_back("aniso_" + letter + k);
            }
            const int digits = letter == "U" ? 4 : 3;
            turn_adps(document.table(block, "_atom_site_anisotrop.", own), 0, move, name, digits);
            turn_adps(document.table(block, "_atom_site.", beside), 0, move, name, digits);
        }
        document.erase(block, kUntrueCategories);
        put_remarks(document, block, remarks);
        break;
    }
    return document.text();
}

std::string new_mmcif(const std::vector<FileAtom>& atoms, const std::string& name, const Remarks& remarks) {
    std::string block_name = name;  // without spaces
    for (char& c : block_name)
        if (static_cast<unsigned char>(c) <= 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '_';
    CifDocument document = CifDocument::with_block(block_name);
    document.set_pair(0, "_entry.id", name);
    put_remarks(document, 0, remarks);
    const auto quoted = [](const std::string& s) { return s.empty() ? std::string("?") : cif_quoted(s); };
    const auto letter = [](char c, const char* none) {
        return c == ' ' || c == '\0' ? std::string(none) : cif_quoted(std::string(1, c));
    };
    std::vector<std::string> sites, adps;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const FileAtom& a = atoms[i];
        // PDB writes charges as 2+, mmCIF as 2.
        std::string charge = a.charge;
        if (charge.size() == 2 && (charge[1] == '+' || charge[1] == '-'))
            charge = (charge[1] == '-' ? "-" : "") + charge.substr(0, 1);
        sites.insert(sites.end(),
                     {a.het ? "HETATM" : "ATOM", std::to_string(i + 1), quoted(a.element), quoted(a.name),
                      letter(a.alternate, "."), quoted(a.residue_name), quoted(a.chain),
                      a.het ? std::string(".") : quoted(a.residue), quoted(a.residue), quoted(a.chain),
                      letter(a.insertion, "?"), fixed(a.place_a.x(), 3), fixed(a.place_a.y(), 3),
                      fixed(a.place_a.z(), 3), fixed(a.occupancy, 2), fixed(a.b_iso, 2), quoted(charge),
                      std::to_string(a.model)});
        if (!a.adp_u) continue;
        const Adp& u = *a.adp_u;
        adps.insert(adps.end(), {std::to_string(i + 1), quoted(a.element), fixed(u[0], 4), fixed(u[1], 4),
                                 fixed(u[2], 4), fixed(u[3], 4), fixed(u[4], 4), fixed(u[5], 4)});
    }
    document.add_table(
        0, "_atom_site.",
        {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id", "label_asym_id",
         "label_seq_id", "auth_seq_id", "auth_asym_id", "pdbx_PDB_ins_code", "Cartn_x", "Cartn_y", "Cartn_z",
         "occupancy", "B_iso_or_equiv", "pdbx_formal_charge", "pdbx_PDB_model_num"},
        std::move(sites));
    if (!adps.empty())
        document.add_table(
            0, "_atom_site_anisotrop.",
            {"id", "type_symbol", "U[1][1]", "U[2][2]", "U[3][3]", "U[1][2]", "U[1][3]", "U[2][3]"},
            std::move(adps));
    return document.text();
}

}  // namespace tact
