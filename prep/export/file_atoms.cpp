#include "prep/export/file_atoms.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include "ipc/base/error.hpp"
#include "prep/cif/cif_document.hpp"

namespace tact {
namespace {

constexpr double kLargest = 1e5;

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {  // from 1, as in PDB
    return line.size() < first ? std::string_view() : line.substr(first - 1, last - first + 1);
}

double number_or(std::string_view text, double otherwise) {
    text = trimmed(text);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole =
        error == std::errc() && end == text.data() + text.size() && std::abs(value) <= kLargest;
    return whole ? value : otherwise;
}

}  // namespace

double file_number(std::string_view text, const char* what, const std::string& name,
                   const std::string& where) {
    text = trimmed(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const double value = number_or(text, HUGE_VAL);
    if (std::abs(value) <= kLargest) return value;
    std::string shown(text.substr(0, 16));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    throw StartupError("read structure " + name,
                       where + ": " + what + " '" + shown + "' is not a number from -100000 to 100000",
                       "repair the file, or fetch it again");
}

std::vector<FileAtom> pdb_atoms(std::string_view text, const std::string& name) {
    std::vector<FileAtom> atoms;
    int model = 1;
    std::size_t line_number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        const std::string where = "line " + std::to_string(++line_number);
        if (line.starts_with("MODEL ") && !atoms.empty()) ++model;
        if (line.starts_with("TER") && !atoms.empty()) atoms.back().ends_chain = true;
        if (line.starts_with("ANISOU") && !atoms.empty()) {
            Adp u{};
            for (std::size_t k = 0; k < 6; ++k)
                u[k] = 1e-4 * file_number(columns(line, 29 + 7 * k, 35 + 7 * k), "U", name, where);
            atoms.back().adp_u = u;
        }
        if (!line.starts_with("ATOM  ") && !line.starts_with("HETATM")) continue;
        FileAtom a;
        a.het = line.starts_with("HETATM");
        a.model = model;
        a.name = trimmed(columns(line, 13, 16));
        if (line.size() > 16) a.alternate = line[16];
        a.residue_name = trimmed(columns(line, 18, 20));
        a.chain = trimmed(columns(line, 21, 22));
        a.residue = trimmed(columns(line, 23, 26));
        if (line.size() > 26) a.insertion = line[26];
        a.place_a = Vec3(file_number(columns(line, 31, 38), "x", name, where),
                         file_number(columns(line, 39, 46), "y", name, where),
                         file_number(columns(line, 47, 54), "z", name, where));
        a.occupancy = number_or(columns(line, 55, 60), 1.0);
        a.b_iso = number_or(columns(line, 61, 66), 0.0);
        a.element = trimmed(columns(line, 77, 78));
        a.charge = trimmed(columns(line, 79, 80));
        atoms.push_back(std::move(a));
    }
    return atoms;
}

std::vector<FileAtom> mmcif_atoms(std::string_view text, const std::string& name) {
    std::optional<CifDocument> document;
    try {
        document = CifDocument::read(text, name);
    } catch (const std::exception&) {
        throw StartupError("read structure " + name, "the file is not mmCIF", "fetch the file again");
    }
    std::vector<FileAtom> atoms;
    for (std::size_t block = 0; block < document->blocks(); ++block) {
        const CifTable table = document->table(block, "_atom_site.",
                                               {"Cartn_x",
                                                "Cartn_y",
                                                "Cartn_z",
                                                "?group_PDB",
                                                "?type_symbol",
                                                "?auth_atom_id",
                                                "?label_atom_id",
                                                "?auth_comp_id",
                                                "?label_comp_id",
                                                "?auth_asym_id",
                                                "?label_asym_id",
                                                "?auth_seq_id",
                                                "?label_seq_id",
                                                "?pdbx_PDB_ins_code",
                                                "?label_alt_id",
                                                "?occupancy",
                                                "?B_iso_or_equiv",
                                                "?pdbx_formal_charge",
                                                "?pdbx_PDB_model_num",
                                                "?id"});
        if (table.rows() == 0) continue;
        std::vector<std::pair<std::string, std::size_t>> ids;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const std::string where = "atom_site row " + std::to_string(row + 1);
            const auto one = [&](std::size_t column) { return table.value(row, column); };
            const auto either = [&](std::size_t column) {
                const std::string value = one(column);
                return value.empty() ? one(column + 1) : value;
            };
            FileAtom a;
            a.place_a = Vec3(file_number(table.raw(row, 0), "Cartn_x", name, where),
                             file_number(table.raw(row, 1), "Cartn_y", name, where),
                             file_number(table.raw(row, 2), "Cartn_z", name, where));
            a.het = one(3) == "HETATM";
            a.element = one(4);
            a.name = either(5);
            a.residue_name = either(7);
            a.chain = either(9);
            a.residue = either(11);
            if (const std::string s = one(13); !s.empty()) a.insertion = s.front();
            if (const std::string s = one(14); !s.empty()) a.alternate = s.front();
            a.occupancy = number_or(one(15), 1.0);
            a.b_iso = number_or(one(16), 0.0);
            a.charge = one(17);
            a.model = static_cast<int>(number_or(one(18), 1.0));
            ids.emplace_back(one(19), atoms.size());
            atoms.push_back(std::move(a));
        }
        const CifTable adp =
            document->table(block, "_atom_site_anisotrop.",
                            {"id", "U[1][1]", "U[2][2]", "U[3][3]", "U[1][2]", "U[1][3]", "U[2][3]"});
        const std::unordered_map<std::string, std::size_t> atom_of(ids.begin(), ids.end());
        for (std::size_t row = 0; row < adp.rows(); ++row) {
            const auto at = atom_of.find(adp.value(row, 0));
            bool known = at != atom_of.end();
            for (std::size_t k = 1; k <= 6; ++k) known = known && adp.known(row, k);
            if (!known) continue;
            Adp u{};
            for (std::size_t k = 0; k < 6; ++k)
                u[k] = file_number(adp.raw(row, k + 1), "U", name, "atom_site_anisotrop");
            atoms[at->second].adp_u = u;
        }
        break;
    }
    return atoms;
}

}  // namespace tact
