#include "prep/export/export_bodies.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "prep/export/bent_places.hpp"
#include "prep/export/fit_remarks.hpp"
#include "prep/export/residue_column.hpp"
#include "prep/export/write_structure_file.hpp"
#include "prep/input/read_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFileBytesMax = std::uint64_t{1} << 30;
constexpr char kAttempt[] = "save the placed structures";

struct Source {
    fs::path path;
    std::string text;
    bool mmcif = false;
    std::string stem;  // "1oel" of 1oel.pdb.gz
};

std::string stem_of(const fs::path& path) {
    fs::path name = path.filename();
    if (name.extension() == ".gz" || name.extension() == ".GZ") name = name.stem();
    return name.stem().string();
}

// The source files in the scene's note, in the order of the structures.
std::vector<Source> sources_of(const SceneFile& scene, std::uint32_t structures) {
    std::vector<std::pair<std::string, std::string>> named;  // path and mark
    std::istringstream lines(read_note(scene));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("structure: ")) named.emplace_back(line.substr(11), "");
        if (line.starts_with("structure check: ") && !named.empty()) named.back().second = line.substr(17);
    }
    std::vector<Source> sources;
    if (named.size() != structures || named.front().second.empty())
        throw StartupError(kAttempt,
                           scene.name() +
                               " does not name the files of its structures; it is synthetic, or an older "
                               "tact-prep baked it",
                           "bake the scene from files: tact-prep dock MAP MODEL -o SCENE");
    for (const auto& [path, mark] : named) {
        std::error_code ignored;
        if (!fs::exists(path, ignored))
            throw StartupError(kAttempt,
                               "the file " + path + ", from which the scene was baked, does not exist",
                               "restore the file, or bake the scene again from its present path");
        if (const std::string now = file_mark(path); now != mark) {
            std::string why = "the file ";
            why.append(path).append(" has changed since the scene was baked: it had ").append(mark);
            throw StartupError(kAttempt, why.append(", and has ").append(now),
                               "bake the scene again, or restore the file");
        }
        Source s;
        s.path = path;
        const std::string ending = format_ending(path);
        s.mmcif = ending == ".cif" || ending == ".mmcif";
        s.stem = stem_of(path);
        const std::vector<char> bytes = read_whole_file(path, kFileBytesMax);
        s.text.assign(bytes.begin(), bytes.end());
        sources.push_back(std::move(s));
    }
    return sources;
}

// A, B, … Z, a … z, 0 … 9, then AA, AB, … ZZ, AAA, …; only mmCIF has room for ids of two letters and more.
std::string chain_id(std::size_t n) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    if (n < kLetters.size()) return std::string(1, kLetters[n]);
    std::string id;
    for (n = n - kLetters.size() + 26;; n = n / 26 - 1) {
        id.insert(id.begin(), kLetters[n % 26]);
        if (n < 26) return id;
    }
}

// The fit of the residues of one body, together with all others.
std::vector<ResidueFit> residues_of(const DensityGrid& grid, const SceneMeta& meta,
                                    const std::vector<Structure>& structures,
                                    const std::vector<PlacedBody>& bodies, std::size_t body, int window) {
    std::vector<PlacedStructure> placed{{&structures[bodies[body].structure], bodies[body].T_model_body}};
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (i != body) placed.push_back({&structures[bodies[i].structure], bodies[i].T_model_body});
    return residue_fit(
        grid, placed,
        {.resolution_m = meta.resolution_m, .background = meta.map_background, .sigma = meta.map_sigma},
        window);
}

std::vector<FileAtom> atoms_of(const Source& s) {
    return s.mmcif ? mmcif_atoms(s.text, s.path.string()) : pdb_atoms(s.text, s.path.string());
}

// A body in its own shape: bent if its modes have amplitudes.
struct Shaped {
    Structure structure;
    std::vector<Vec3> at_a;  // bent places of the atoms of its file; empty: straight
    Remarks remarks;
};

Shaped shaped(const SceneFile& scene, const Structure& structure, const PlacedBody& body,
              const Source& source) {
    Shaped out{structure, {}, {}};
    if (std::all_of(body.amplitude_m.begin(), body.amplitude_m.end(), [](float a) { return a == 0.0F; }))
        return out;
    const NormalModes modes = read_modes(scene, body.structure, structure);
    if (modes.count() < body.amplitude_m.size())
        throw StartupError(kAttempt,
                           "body " + std::to_string(body.id) + " is bent along " +
                               std::to_string(body.amplitude_m.size()) + " modes, and its structure has " +
                               std::to_string(modes.count()) + " in " + scene.name(),
                           "give the scene in which the body was bent");
    out.structure = bent_structure(structure, modes, body.amplitude_m);
    BentPlaces bent = bent_places(atoms_of(source), structure, modes, body.amplitude_m);
    out.at_a = std::move(bent.at_a);
    char text[200];
    std::snprintf(
        text, sizeof text,
        "along %zu normal modes, RMSD to the file %.2f angstrom; %zu bonds within %.2f %% of the file "
        "(%.0f %% before they were brought back)",
        body.amplitude_m.size(), bent.rmsd_a, bent.bonds, 100.0 * bent.bond_most,
        100.0 * bent.bond_most_modes);
    out.remarks.emplace_back("bent", text);
    return out;
}

// The first model of every body, in the order of the bodies. sources and shapes: one per body.
std::vector<FileAtom> all_atoms(const std::vector<Source>& sources, const std::vector<Shaped>& shapes,
                                const std::vector<PlacedBody>& bodies, const std::vector<AtomMove>& moves,
                                Remarks& remarks) {
    std::vector<FileAtom> all;
    std::size_t chains = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Source& s = sources[i];
        std::vector<FileAtom> atoms = atoms_of(s);
        for (std::size_t k = 0; k < shapes[i].at_a.size(); ++k) atoms[k].place_a = shapes[i].at_a[k];
        std::map<std::string, std::string> renamed;
        std::string listed;
        const int model = atoms.empty() ? 1 : atoms.front().model;
        for (FileAtom& a : atoms) {
            if (a.model != model) break;
            const auto [at, fresh] = renamed.try_emplace(a.chain, "");
            if (fresh) {
                at->second = chain_id(chains++);
                listed += (listed.empty() ? "" : " ") + at->second;
            }
            a.chain = at->second;
            a.model = 1;
            a.place_a = moves[i] * a.place_a;
            if (a.adp_u) a.adp_u = moves[i].turned(*a.adp_u);
            all.push_back(std::move(a));
        }
        remarks.emplace_back("chains_of_body_" + std::to_string(bodies[i].id), listed + " of " + s.stem);
    }
    return all;
}

// Writes to a temporary file first, so that the target is either whole or absent.
void write_whole(const fs::path& path, const std::string& text) {
    const fs::path part = path.string() + ".part" + std::to_string(::getpid());
    std::error_code ignored;
    fs::remove(part, ignored);  // also a link
    {
        std::ofstream out(part, std::ios::binary | std::ios::trunc);
        out << text << std::flush;
        if (!out) {
            fs::remove(part, ignored);
            throw StartupError(kAttempt, part.string() + " could not be written",
                               "check the free space and the permissions of the folder");
        }
    }
    std::error_code failed;
    fs::rename(part, path, failed);
    if (failed)
        throw StartupError(kAttempt, path.string() + ": " + failed.message(),
                           "check that the folder exists and is writable");
}

void check_targets(const std::vector<std::pair<fs::path, std::string>>& files,
                   const std::vector<Source>& sources, bool force) {
    for (const auto& [path, text] : files) {
        std::error_code ignored;
        for (const Source& s : sources)
            if (fs::equivalent(path, s.path, ignored))
                throw StartupError(kAttempt, path.string() + " is a file from which the scene was baked",
                                   "give another folder with -o");
        if (!force && (fs::exists(path, ignored) || fs::is_symlink(path, ignored)))
            throw StartupError(kAttempt, path.string() + " already exists",
                               "give another folder with -o, or --force to overwrite the file");
    }
}

}  // namespace

std::vector<fs::path> export_bodies(const SceneFile& scene, const std::vector<PlacedBody>& bodies,
                                    const ExportOptions& options) {
    const SceneMeta meta = read_meta(scene);
    const std::vector<Source> sources = sources_of(scene, meta.body_count);
    std::vector<Structure> structures;
    for (std::uint32_t i = 0; i < meta.body_count; ++i) structures.push_back(read_structure(scene, i));
    std::vector<Shaped> shapes;
    std::vector<Structure> structure_of_body;
    std::vector<PlacedBody> in_shape = bodies;  // by body
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const std::uint32_t structure = bodies[i].structure;
        shapes.push_back(shaped(scene, structures[structure], bodies[i], sources.at(structure)));
        structure_of_body.push_back(shapes.back().structure);
        in_shape[i].structure = static_cast<std::uint32_t>(i);
    }
    const SavedFit fit = fit_of(scene, structure_of_body, in_shape, options.contour.value_or(meta.contour));
    const DensityGrid grid = options.residues > 0 ? read_grid(scene) : DensityGrid{};
    std::vector<std::pair<fs::path, std::string>> files;
    std::vector<AtomMove> moves;
    std::vector<Source> written;  // by body
    std::string table = kCsvHead;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const PlacedBody& body = bodies[i];
        Source& source = written.emplace_back(sources.at(body.structure));
        const Structure& s = structures[body.structure];
        moves.push_back(AtomMove::of(body.T_model_body, s.home_com_model_m));
        const AtomMove& move = moves.back();
        Remarks remarks = remarks_of(meta, fit, i, bodies.size(), &body, &move);
        remarks.insert(remarks.end(), shapes[i].remarks.begin(), shapes[i].remarks.end());
        // The body id makes file names unique, also if two structures have the same name.
        const std::string stem = source.stem + "-body" + std::to_string(body.id);
        std::string residue_table;
        if (options.residues > 0) {
            const std::vector<ResidueFit> residues =
                residues_of(grid, meta, structure_of_body, in_shape, i, options.residues);
            residue_table = residue_csv(
                s, residues,
                options.local_resolution
                    ? local_resolutions(*options.local_resolution,
                                        {&structure_of_body[i], in_shape[i].T_model_body}, residues)
                    : std::vector<std::optional<double>>{});
            if (options.b_column) {
                source.text = with_b_column(source.text, source.mmcif, source.path.string(), s, residues);
                std::string window = "correlation about the mean, window in residues: ";
                remarks.emplace_back("b_column", window.append(std::to_string(options.residues)));
            }
        }
        std::string name = stem + ".cif", text;
        if (source.mmcif) {
            text = moved_mmcif(source.text, source.path.string(), move, remarks, shapes[i].at_a);
        } else if (auto pdb = moved_pdb(source.text, source.path.string(), move, remarks, shapes[i].at_a)) {
            name = stem + ".pdb";
            text = std::move(*pdb);
        } else {  // a coordinate does not fit the columns of PDB
            std::vector<FileAtom> atoms = atoms_of(source);
            for (std::size_t k = 0; k < atoms.size(); ++k) {
                FileAtom& a = atoms[k];
                a.place_a = move * (shapes[i].at_a.empty() ? a.place_a : shapes[i].at_a[k]);
                if (a.adp_u) a.adp_u = move.turned(*a.adp_u);
            }
            text = new_mmcif(atoms, stem, remarks);
        }
        table += csv_row(body, s.name, name, move, fit, i);
        files.emplace_back(options.folder / name, std::move(text));
        files.emplace_back(options.folder / (stem + ".matrix.txt"), matrix_text(body, s.name, move));
        if (options.residues > 0)
            files.emplace_back(options.folder / (stem + ".residues.csv"), residue_table);
    }
    files.emplace_back(options.folder / "bodies.csv", table);
    if (options.combined) {
        Remarks remarks = remarks_of(meta, fit, 0, bodies.size(), nullptr, nullptr);
        const std::vector<FileAtom> atoms = all_atoms(written, shapes, bodies, moves, remarks);
        const bool mmcif =
            std::any_of(sources.begin(), sources.end(), [](const Source& s) { return s.mmcif; });
        auto pdb = mmcif ? std::nullopt : new_pdb(atoms, remarks);
        const char* const name = pdb ? "combined.pdb" : "combined.cif";
        files.emplace_back(options.folder / name, pdb ? *pdb : new_mmcif(atoms, "combined", remarks));
    }
    check_targets(files, sources, options.force);
    std::error_code failed;
    fs::create_directories(options.folder, failed);
    if (failed)
        throw StartupError(kAttempt, "the folder " + options.folder.string() + ": " + failed.message(),
                           "give another folder with -o");
    std::vector<fs::path> paths;
    for (const auto& [path, text] : files) {
        write_whole(path, text);
        paths.push_back(path);
    }
    return paths;
}

}  // namespace tact
