#include "prep/export/residue_column.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/fit/fit_sums.hpp"
#include "prep/cif/cif_document.hpp"
#include "prep/export/file_atoms.hpp"

namespace tact {
namespace {

constexpr std::size_t kBColumn = 60, kBWidth = 6;  // of an atom's line in a PDB file

// By chain and number, as the file writes them.
using Column = std::map<std::pair<std::string, std::string>, double>;

Column column_of(const Structure& s, const std::vector<ResidueFit>& fit) {
    Column column;
    for (const ResidueFit& r : fit)
        if (r.correlation) column[{s.chain_names[r.chain], std::to_string(r.residue)}] = *r.correlation;
    return column;
}

std::string value_of(const Column& column, const FileAtom& atom) {
    const auto found = column.find({atom.chain, atom.residue});
    char text[16];
    std::snprintf(text, sizeof text, "%6.2f", found == column.end() ? 0.0 : found->second);
    return text;
}

std::string in_pdb(std::string_view text, const std::vector<FileAtom>& atoms, const Column& column) {
    std::string out;
    out.reserve(text.size());
    std::size_t next = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string line(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.starts_with("ATOM  ") || line.starts_with("HETATM")) {
            if (!line.empty() && line.back() == '\r') line.pop_back();
            if (line.size() < kBColumn + kBWidth) line.resize(kBColumn + kBWidth, ' ');
            line.replace(kBColumn, kBWidth, value_of(column, atoms[next++]));
        }
        out += line + '\n';
    }
    return out;
}

std::string in_mmcif(std::string_view text, const std::string& name, const std::vector<FileAtom>& atoms,
                     const Column& column) {
    CifDocument document = CifDocument::read(text, name);
    std::size_t next = 0;
    for (std::size_t block = 0; block < document.blocks(); ++block) {
        if (document.table(block, "_atom_site.", {"Cartn_x", "Cartn_y", "Cartn_z"}).rows() == 0) continue;
        CifTable table = document.table(block, "_atom_site.", {"B_iso_or_equiv"});
        if (table.rows() == 0)
            throw StartupError("write the fit of residues into the B column of " + name,
                               "the file has no column B_iso_or_equiv",
                               "leave out --b-column: the CSV file has the values");
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const std::string value = value_of(column, atoms[next++]);
            table.set(row, 0, value.substr(value.find_first_not_of(' ')));
        }
        break;
    }
    return document.text();
}

}  // namespace

std::vector<std::optional<double>> local_resolutions(const DensityGrid& map, const PlacedStructure& placed,
                                                     const std::vector<ResidueFit>& fit) {
    std::vector<std::optional<double>> out;
    for (const ResidueFit& r : fit) {
        double sum = 0.0;
        std::size_t inside = 0;
        for (std::size_t i = r.first_atom; i < r.first_atom + r.atoms; ++i) {
            const double value = map_at(map, atom_in_voxels(map, placed, i), std::nan(""));
            if (std::isnan(value)) continue;
            sum += value;
            ++inside;
        }
        out.push_back(inside > 0 ? std::optional(sum / static_cast<double>(inside)) : std::nullopt);
    }
    return out;
}

std::string residue_csv(const Structure& structure, const std::vector<ResidueFit>& fit,
                        const std::vector<std::optional<double>>& local_resolution_a) {
    const bool local = local_resolution_a.size() == fit.size() && !fit.empty();
    std::string out = std::string("chain,residue,atoms,density_sigma,correlation") +
                      (local ? ",local_resolution_a\n" : "\n");
    for (std::size_t i = 0; i < fit.size(); ++i) {
        const ResidueFit& r = fit[i];
        char line[128];
        std::snprintf(line, sizeof line, ",%d,%zu,%.4f,", r.residue, r.atoms, r.density_sigma);
        out += structure.chain_names[r.chain] + line;
        if (r.correlation) {
            std::snprintf(line, sizeof line, "%.4f", *r.correlation);
            out += line;
        }
        if (local) out += local_resolution_a[i] ? printed(",%.3f", *local_resolution_a[i]) : ",";
        out += '\n';
    }
    return out;
}

std::string with_b_column(std::string_view text, bool mmcif, const std::string& name,
                          const Structure& structure, const std::vector<ResidueFit>& fit) {
    const Column column = column_of(structure, fit);
    return mmcif ? in_mmcif(text, name, mmcif_atoms(text, name), column)
                 : in_pdb(text, pdb_atoms(text, name), column);
}

}  // namespace tact
