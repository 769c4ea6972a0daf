#include "prep/structure/atom_rows.hpp"

#include <charconv>
#include <cmath>
#include <gemmi/elem.hpp>
#include <gemmi/model.hpp>
#include <gemmi/pdb.hpp>
#include <gemmi/resinfo.hpp>
#include <optional>

#include "ipc/base/error.hpp"
#include "prep/cif/cif_document.hpp"

namespace tact {
namespace {

constexpr double kFarthestA = 1e5;
constexpr std::size_t kRowsMax = 20'000'000;
constexpr double kMassUnknownU = 12.0;  // an atom of unknown element counts as carbon

constexpr char kFixFile[] = "repair the file, or fetch it again";

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

std::optional<double> number(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Keeps only printable characters of a malicious file in messages.
std::string shortly(std::string_view text, std::size_t longest) {
    std::string out(text.substr(0, longest));
    for (char& c : out) {
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    }
    return out;
}

double coordinate(std::string_view text, const char* axis, const std::string& name,
                  const std::string& where) {
    const std::optional<double> value = number(trimmed(text));
    const std::string shown = std::string(axis) + " '" + shortly(trimmed(text), 16) + "'";
    if (!value || !std::isfinite(*value))
        throw StartupError("read structure " + name, where + ": " + shown + " is not a number", kFixFile);
    if (std::abs(*value) > kFarthestA) {
        throw StartupError("read structure " + name,
                           where + ": " + shown + " is more than 100000 ångström from the origin", kFixFile);
    }
    return *value;
}

void set_kind(AtomRow& row, gemmi::Element element) {
    row.element = static_cast<std::uint8_t>(element.atomic_number());
    row.mass_u = row.element == 0 ? kMassUnknownU : element.weight();
    row.hydrogen = element.is_hydrogen();
    const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(row.residue_name);
    row.water = info.is_water();
    row.nucleic = info.is_nucleic_acid();
}

void check_count(std::size_t rows, const std::string& name) {
    if (rows > kRowsMax)
        throw StartupError("read structure " + name, "the file has more than 20 million atoms",
                           "split the file into several files");
}

}  // namespace

std::vector<AtomRow> pdb_rows(std::string_view text, const std::string& name) {
    // Pass gemmi only the atom lines of the first model, padded to full length.
    std::string atoms;
    std::size_t line_number = 0, rows_seen = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line_number;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        if (line.starts_with("ENDMDL") && rows_seen > 0) break;
        if (!line.starts_with("ATOM  ") && !line.starts_with("HETATM")) continue;
        const std::string where = "line " + std::to_string(line_number);
        if (line.size() < 54)
            throw StartupError("read structure " + name,
                               where + ": the atom line ends before column 54, the end of the coordinates",
                               kFixFile);
        if (line.find('\0') != std::string_view::npos)
            throw StartupError("read structure " + name, where + ": the line contains zero bytes", kFixFile);
        coordinate(line.substr(30, 8), "x", name, where);
        coordinate(line.substr(38, 8), "y", name, where);
        coordinate(line.substr(46, 8), "z", name, where);
        check_count(++rows_seen, name);
        std::string padded(line.substr(0, 80));
        padded.resize(80, ' ');
        atoms += padded;
        atoms += '\n';
    }
    std::vector<AtomRow> rows;
    if (atoms.empty()) return rows;
    gemmi::Structure structure;
    try {
        structure = gemmi::read_pdb_from_memory(atoms.data(), atoms.size(), name);
    } catch (const std::exception& error) {
        throw StartupError("read structure " + name, shortly(error.what(), 200), kFixFile);
    }
    if (structure.models.empty()) return rows;
    rows.reserve(rows_seen);
    for (const gemmi::Chain& chain : structure.models.front().chains) {
        for (const gemmi::Residue& residue : chain.residues) {
            for (const gemmi::Atom& atom : residue.atoms) {
                AtomRow row;
                row.chain = shortly(chain.name, 8);
                row.residue_name = residue.name;
                row.atom_name = atom.name;
                row.residue = residue.seqid.num.has_value() ? *residue.seqid.num : 0;
                row.insertion = residue.seqid.icode;
                row.alternate = atom.altloc;
                row.occupancy = atom.occ;
                row.position_a = Vec3(atom.pos.x, atom.pos.y, atom.pos.z);
                set_kind(row, atom.element);
                rows.push_back(std::move(row));
            }
        }
    }
    return rows;
}

std::vector<AtomRow> mmcif_rows(std::string_view text, const std::string& name) {
    std::optional<CifDocument> document;
    try {
        document = CifDocument::read(text, name);
    } catch (const std::exception& error) {
        throw StartupError("read structure " + name, shortly(error.what(), 200), kFixFile);
    }
    std::vector<AtomRow> rows;
    for (std::size_t block = 0; block < document->blocks(); ++block) {
        enum : std::size_t {
            x,
            y,
            z,
            element,
            residue_name,
            auth_name,
            auth_atom,
            label_atom,
            auth_chain,
            label_chain,
            auth_seq,
            label_seq,
            insertion,
            alternate,
            occupancy,
            model
        };
        const CifTable table = document->table(
            block, "_atom_site.",
            {"Cartn_x", "Cartn_y", "Cartn_z", "?type_symbol", "?label_comp_id", "?auth_comp_id",
             "?auth_atom_id", "?label_atom_id", "?auth_asym_id", "?label_asym_id", "?auth_seq_id",
             "?label_seq_id", "?pdbx_PDB_ins_code", "?label_alt_id", "?occupancy", "?pdbx_PDB_model_num"});
        if (table.rows() == 0) continue;
        check_count(table.rows(), name);
        std::string first_model;
        for (std::size_t index = 0; index < table.rows(); ++index) {
            const std::string where = "atom_site row " + std::to_string(index + 1);
            const auto text_of = [&](std::size_t column) { return table.value(index, column); };
            const auto either = [&](std::size_t first, std::size_t second) {
                const std::string value = text_of(first);
                return value.empty() ? text_of(second) : value;
            };
            const std::string model_name = text_of(model);
            if (index == 0) first_model = model_name;
            if (model_name != first_model) continue;
            AtomRow row;
            row.position_a = Vec3(coordinate(table.raw(index, x), "Cartn_x", name, where),
                                  coordinate(table.raw(index, y), "Cartn_y", name, where),
                                  coordinate(table.raw(index, z), "Cartn_z", name, where));
            row.chain = shortly(either(auth_chain, label_chain), 8);
            row.residue_name = either(auth_name, residue_name);
            row.atom_name = either(auth_atom, label_atom);
            const std::string sequence = either(auth_seq, label_seq);
            if (!sequence.empty()) {
                const std::optional<double> value = number(sequence);
                if (!value || !(std::abs(*value) <= 1e9))
                    throw StartupError(
                        "read structure " + name,
                        where + ": residue number '" + shortly(sequence, 16) + "' is not a number", kFixFile);
                row.residue = static_cast<std::int32_t>(*value);
            }
            const std::string icode = text_of(insertion), altloc = text_of(alternate),
                              occ = text_of(occupancy);
            if (!icode.empty()) row.insertion = icode.front();
            if (!altloc.empty()) row.alternate = altloc.front();
            if (!occ.empty()) row.occupancy = static_cast<float>(number(occ).value_or(0.0));
            const std::string symbol = text_of(element);
            set_kind(row, symbol.size() <= 2 ? gemmi::Element(symbol) : gemmi::Element(gemmi::El::X));
            rows.push_back(std::move(row));
        }
        break;
    }
    return rows;
}

}  // namespace tact
