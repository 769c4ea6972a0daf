#include <array>
#include <cstdio>
#include <gemmi/cif.hpp>
#include <gemmi/to_cif.hpp>
#include <sstream>

#include "ipc/base/error.hpp"
#include "prep/export/write_structure_file.hpp"

namespace tact {
namespace {

namespace cif = gemmi::cif;

// Hold only where the file had the atoms.
constexpr std::array kUntrueCategories{"_cell.",
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

void put_remarks(cif::Block& block, const Remarks& remarks) {
    for (const auto& [key, value] : remarks) block.set_pair("_tact_fit." + key, cif::quote(value));
}

std::string written(const cif::Document& document) {
    std::ostringstream out;
    cif::write_cif_to_stream(out, document);
    return out.str();
}

// U[1][1] … or B[1][1] …, whatever the table has; "." and "?" stay.
void turn_adps(cif::Table table, int first, const AtomMove& move, const std::string& name, int digits) {
    for (cif::Table::Row r : table) {
        Adp u{};
        bool all = true;
        for (int k = 0; k < 6; ++k) {
            all = all && r.has2(static_cast<std::size_t>(first + k));
            if (all) u[static_cast<std::size_t>(k)] = file_number(r[first + k], "ADP", name, "an ADP");
        }
        if (!all) continue;
        u = move.turned(u);
        for (int k = 0; k < 6; ++k) r[first + k] = fixed(u[static_cast<std::size_t>(k)], digits);
    }
}

}  // namespace

std::string moved_mmcif(std::string_view text, const std::string& name, const AtomMove& move,
                        const Remarks& remarks) {
    (void)mmcif_atoms(text, name);  // every number checked, and that it is mmCIF
    cif::Document document = cif::read_memory(text.data(), text.size(), name.c_str());
    for (cif::Block& block : document.blocks) {
        cif::Table places =
            block.find("_atom_site.", {"Cartn_x", "Cartn_y", "Cartn_z", "?fract_x", "?fract_y", "?fract_z"});
        if (places.length() == 0) continue;
        for (cif::Table::Row r : places) {
            const auto number = [&](int k) { return file_number(r[k], "a coordinate", name, "atom_site"); };
            const Vec3 p = move * Vec3(number(0), number(1), number(2));
            for (int k = 0; k < 3; ++k) {
                r[k] = fixed(p[k], 3);
                if (r.has(static_cast<std::size_t>(3 + k))) r[3 + k] = "?";  // of a cell that is gone
            }
        }
        for (const std::string letter : {"U", "B"}) {
            std::vector<std::string> own, beside;
            for (const char* const k : {"[1][1]", "[2][2]", "[3][3]", "[1][2]", "[1][3]", "[2][3]"}) {
                own.push_back(letter + k);
                beside.push_back("aniso_" + letter + k);
            }
            const int digits = letter == "U" ? 4 : 3;
            turn_adps(block.find("_atom_site_anisotrop.", own), 0, move, name, digits);
            turn_adps(block.find("_atom_site.", beside), 0, move, name, digits);
        }
        for (cif::Item& item : block.items)
            for (const char* const category : kUntrueCategories)
                if (item.has_prefix(category)) item.erase();
        put_remarks(block, remarks);
        break;
    }
    return written(document);
}

std::string new_mmcif(const std::vector<FileAtom>& atoms, const std::string& name, const Remarks& remarks) {
    cif::Document document;
    std::string block_name = name;  // no blanks in it
    for (char& c : block_name)
        if (static_cast<unsigned char>(c) <= 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '_';
    document.blocks.emplace_back(block_name);
    cif::Block& block = document.blocks.back();
    block.set_pair("_entry.id", cif::quote(name));
    put_remarks(block, remarks);
    cif::Loop& sites = block.init_loop(
        "_atom_site.",
        {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id", "label_asym_id",
         "label_seq_id", "auth_seq_id", "auth_asym_id", "pdbx_PDB_ins_code", "Cartn_x", "Cartn_y", "Cartn_z",
         "occupancy", "B_iso_or_equiv", "pdbx_formal_charge", "pdbx_PDB_model_num"});
    const auto quoted = [](const std::string& s) { return s.empty() ? std::string("?") : cif::quote(s); };
    const auto letter = [](char c, const char* none) {
        return c == ' ' || c == '\0' ? std::string(none) : cif::quote(std::string(1, c));
    };
    bool any_adp = false;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const FileAtom& a = atoms[i];
        any_adp = any_adp || a.adp_u;
        // PDB writes charges as 2+, mmCIF as 2.
        std::string charge = a.charge;
        if (charge.size() == 2 && (charge[1] == '+' || charge[1] == '-'))
            charge = (charge[1] == '-' ? "-" : "") + charge.substr(0, 1);
        sites.add_row({a.het ? "HETATM" : "ATOM", std::to_string(i + 1), quoted(a.element), quoted(a.name),
                       letter(a.alternate, "."), quoted(a.residue_name), quoted(a.chain),
                       a.het ? std::string(".") : quoted(a.residue), quoted(a.residue), quoted(a.chain),
                       letter(a.insertion, "?"), fixed(a.place_a.x(), 3), fixed(a.place_a.y(), 3),
                       fixed(a.place_a.z(), 3), fixed(a.occupancy, 2), fixed(a.b_iso, 2), quoted(charge),
                       std::to_string(a.model)});
    }
    if (any_adp) {
        cif::Loop& adps = block.init_loop(
            "_atom_site_anisotrop.",
            {"id", "type_symbol", "U[1][1]", "U[2][2]", "U[3][3]", "U[1][2]", "U[1][3]", "U[2][3]"});
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            if (!atoms[i].adp_u) continue;
            const Adp& u = *atoms[i].adp_u;
            adps.add_row({std::to_string(i + 1), quoted(atoms[i].element), fixed(u[0], 4), fixed(u[1], 4),
                          fixed(u[2], 4), fixed(u[3], 4), fixed(u[4], 4), fixed(u[5], 4)});
        }
    }
    return written(document);
}

}  // namespace tact
