#include "prep/structure/import_structure.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "ipc/base/error.hpp"
#include "prep/input/read_file.hpp"
#include "prep/structure/atom_rows.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kFileBytesMax = std::uint64_t{1} << 30;

// Marks the rows to keep among alternate locations. If the alternatives of a residue have different residue names (a
// point mutation in part of the crystal), the name with the highest occupancy of any atom stays.
std::vector<bool> best_alternates(const std::vector<AtomRow>& rows) {
    using Residue = std::tuple<std::string, std::int32_t, char>;
    const auto residue_of = [](const AtomRow& r) { return Residue{r.chain, r.residue, r.insertion}; };
    std::map<Residue, std::pair<float, std::string>> name_of;
    for (const AtomRow& r : rows) {
        if (r.alternate == '\0') continue;
        const auto [at, fresh] = name_of.try_emplace(residue_of(r), r.occupancy, r.residue_name);
        if (!fresh && r.occupancy > at->second.first) at->second = {r.occupancy, r.residue_name};
    }
    std::vector<bool> keep(rows.size(), true);
    std::map<std::pair<Residue, std::string>, std::size_t> best;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const AtomRow& r = rows[i];
        if (r.alternate == '\0') continue;
        if (name_of[residue_of(r)].second != r.residue_name) {
            keep[i] = false;
            continue;
        }
        const auto [at, fresh] = best.try_emplace({residue_of(r), r.atom_name}, i);
        if (fresh) continue;
        const bool better = r.occupancy > rows[at->second].occupancy;
        keep[better ? at->second : i] = false;
        if (better) at->second = i;
    }
    return keep;
}

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (std::size_t i = 0; i < names.size() && i < 12; ++i)
        out += (i > 0 ? " " : "") + (names[i].empty() ? "blank" : names[i]);
    return names.size() > 12 ? out + " ..." : out;
}

void check_ending(const std::string& ending, const std::string& name) {
    if (ending == ".pdb" || ending == ".ent" || ending == ".cif" || ending == ".mmcif") return;
    throw StartupError("read structure " + name,
                       "the file name ending '" + ending + "' is not that of a structure",
                       "give a .pdb, .ent, .cif or .mmcif file, optionally followed by .gz");
}

}  // namespace

ImportedStructure import_structure_bytes(std::string_view bytes, const std::string& name,
                                         const std::string& ending) {
    check_ending(ending, name);
    const std::string attempt = "read structure " + name;
    const std::vector<AtomRow> rows =
        ending == ".cif" || ending == ".mmcif" ? mmcif_rows(bytes, name) : pdb_rows(bytes, name);
    if (rows.empty()) {
        throw StartupError(attempt, "the file has no atoms",
                           "give a PDB or mmCIF file with coordinates (ATOM lines or an _atom_site table)");
    }
    const std::vector<bool> chosen = best_alternates(rows);
    std::vector<std::size_t> kept;
    std::size_t hydrogens = 0, waters = 0, alternates = 0, unknown = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].water) {
            ++waters;
        } else if (rows[i].hydrogen) {
            ++hydrogens;
        } else if (!chosen[i]) {
            ++alternates;
        } else {
            kept.push_back(i);
            if (rows[i].element == 0) ++unknown;
        }
    }
    if (kept.empty()) {
        throw StartupError(attempt,
                           "the file has no atoms besides " + std::to_string(hydrogens) + " hydrogens and " +
                               std::to_string(waters) + " water atoms",
                           "give a structure with heavy atoms");
    }
    std::vector<AtomRow> chosen_rows;
    chosen_rows.reserve(kept.size());
    for (const std::size_t i : kept) chosen_rows.push_back(rows[i]);
    ImportedStructure out;
    out.structure = structure_of(chosen_rows, name);
    const Structure& s = out.structure;
    const auto backbone = std::count(s.trace.begin(), s.trace.end(), std::uint8_t{1});
    out.summary = std::to_string(kept.size()) + " atoms in " + std::to_string(s.chain_names.size()) +
                  (s.chain_names.size() == 1 ? " chain (" : " chains (") + listed(s.chain_names) + "), " +
                  std::to_string(backbone) + " on the backbone; dropped " + std::to_string(hydrogens) +
                  " hydrogens, " + std::to_string(waters) + " water atoms, " + std::to_string(alternates) +
                  " alternate locations";
    if (unknown > 0)
        out.summary += "; " + std::to_string(unknown) + " atoms of unknown element count as carbon";
    return out;
}

ImportedStructure import_structure(const std::filesystem::path& path) {
    const std::string ending = format_ending(path);
    check_ending(ending, path.string());
    const std::vector<char> bytes = read_whole_file(path, kFileBytesMax);
    return import_structure_bytes({bytes.data(), bytes.size()}, path.string(), ending);
}

}  // namespace tact
