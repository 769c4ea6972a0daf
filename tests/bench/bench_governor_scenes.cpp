#include "tests/bench/bench_governor_scenes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "tests/support/map_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using launch::Child;
using launch::ChildSettings;
using Arguments = std::vector<std::string>;

constexpr auto kBakeTimeout = std::chrono::minutes(15);
constexpr double kToolPoints = 1000.0, kVoxels = 512.0, kVoxelMm = 0.1;

std::vector<double> equal_levels(std::size_t steps, double first = 0.0) {
    std::vector<double> levels;
    for (std::size_t i = 0; i <= steps; ++i)
        levels.push_back(std::max(static_cast<double>(i) / static_cast<double>(steps), first));
    return levels;
}

// Writes copies of the atoms of a baked structure, a few angstrom apart, as mmCIF.
void write_copies(const Structure& s, std::size_t copies, const fs::path& file) {
    std::ofstream out(file);
    out << "data_copies\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site."
           "label_atom_id\n"
           "_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n"
           "_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n";
    std::size_t id = 0;
    for (std::size_t c = 0; c < copies; ++c) {
        // The copies lie along a spiral, so that no two coincide.
        const double angle = 2.4 * static_cast<double>(c), r_a = 1.5 * std::sqrt(static_cast<double>(c));
        const Vec3 shift_a(r_a * std::cos(angle), r_a * std::sin(angle),
                           0.7 * std::sin(1.3 * static_cast<double>(c)));
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec3 at_a = (Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                    static_cast<double>(s.z_m[i])) +
                               s.home_com_model_m) /
                                  kAngstromM +
                              shift_a;
            char line[128];
            std::snprintf(line, sizeof line, "ATOM %zu C CA GLY A%zu %zu %.3f %.3f %.3f 1\n", ++id, c,
                          i % 9999 + 1, at_a.x(), at_a.y(), at_a.z());
            out << line;
        }
    }
    if (!out.flush())
        throw StartupError("write " + file.string(), "the write failed", "free some disk space");
}

class Baker {
public:
    Baker(const GovernorSceneSettings& settings, const fs::path& scratch)
        : settings_(settings),
          scratch_(scratch),
          folder_(settings.folder.empty() ? scratch : settings.folder) {
        std::error_code failed;
        fs::create_directories(folder_, failed);
        if (failed)
            throw StartupError("create the folder " + folder_.string(), failed.message(),
                               "choose a writable folder");
    }

    // Copies of a structure that was baked once to read its atoms.
    [[nodiscard]] BenchScene docking(std::size_t atoms) const {
        const fs::path path = folder_ / ("docking-" + std::to_string(atoms) + ".tact");
        if (!fs::exists(path)) bake_copies(atoms, path);
        const SceneFile baked = SceneFile::open(path);
        return {.name = "docking",
                .atoms = read_structure(baked, 0).size(),
                .path = path,
                .knob = "docking.force",
                .levels = equal_levels(read_codebook(baked, 0).levels.size()),
                .arguments = {"--hand", "wander"}};
    }

    [[nodiscard]] BenchScene surface() const {
        const auto points = std::to_string(std::lround(settings_.work * kToolPoints));
        const fs::path path = folder_ / ("surface-" + points + ".tact");
        if (!fs::exists(path))
            bake({"demo", "touch", "--parts", "1000", "--tool", "block", "--tool-points", points,
                  "--no-forest", "--no-picture"},
                 path);
        return {.name = "surface",
                .path = path,
                .knob = "surface.force",
                .levels = equal_levels(4, 0.05),
                .arguments = {"--hand", "stroke"}};
    }

    [[nodiscard]] BenchScene drilling() const {
        const double edge = std::sqrt(settings_.work);
        const auto voxels = std::to_string(std::lround(edge * kVoxels));
        const fs::path path = folder_ / ("drilling-" + voxels + ".tact");
        if (!fs::exists(path))
            bake({"demo", "drill", "--voxels", voxels, "--voxel-mm", std::to_string(kVoxelMm / edge)}, path);
        return {.name = "drilling",
                .path = path,
                .knob = "drilling.force",
                .levels = equal_levels(4),
                .arguments = {"--hand", "surgeon", "--burr-mm", "40", "--pedal", "always"}};
    }

private:
    // A scene that was not finished is not kept.
    void bake(Arguments arguments, const fs::path& path) const {
        const fs::path part = path.parent_path() / ("part-" + path.filename().string());
        arguments.insert(arguments.end(), {"-o", part.string()});
        run_program("tact-prep", arguments, scratch_ / "bake.log", kBakeTimeout);
        std::error_code failed;
        fs::rename(part, path, failed);
        if (failed)
            throw StartupError("bake " + path.string(), launch::read_small(scratch_ / "bake.log"),
                               "bake the scene by hand: tact-prep");
    }

    void bake_copies(std::size_t atoms, const fs::path& path) const {
        const fs::path one = scratch_ / "one.tact", copies = scratch_ / "copies.cif";
        fs::path map = settings_.map;
        if (!fs::exists(one)) {
            if (map.empty())
                bake({"demo", "dock"}, one);
            else
                bake({"dock", map.string(), settings_.structure.string(), "--resolution-a", "10"}, one);
        }
        const SceneFile scene = SceneFile::open(one);
        if (map.empty()) map = scratch_ / "map.mrc";
        if (!fs::exists(map)) launch::write_whole(map, map_file_bytes(read_grid(scene)));
        const Structure structure = read_structure(scene, 0);
        const std::size_t n = std::max<std::size_t>((atoms + structure.size() / 2) / structure.size(), 1);
        write_copies(structure, n, copies);
        bake({"dock", map.string(), copies.string(), "--resolution-a", "10", "--vertices-max", "20000"},
             path);
    }

    const GovernorSceneSettings& settings_;
    fs::path scratch_, folder_;
};

}  // namespace

BenchFolder::BenchFolder() {
    std::string name = (fs::temp_directory_path() / "tact-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw StartupError("create a folder for the scenes in " + fs::temp_directory_path().string(),
                           "mkdtemp failed", "set TMPDIR to a writable folder");
    path = name;
}

BenchFolder::~BenchFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

void run_program(const std::string& name, const Arguments& arguments, const fs::path& log, Duration most) {
    ChildSettings s;
    s.arguments = arguments;
    s.output_fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    Child child(name, launch::find_program(name), s);
    ::close(s.output_fd);
    const auto& ending = child.wait(most);
    if (!ending)
        throw StartupError("run " + name, "the program did not exit in time",
                           "run it by hand: " + name + " " + arguments.front());
}

std::vector<BenchScene> bake_governor_scenes(const GovernorSceneSettings& settings, const fs::path& scratch) {
    const Baker baker(settings, scratch);
    std::vector<BenchScene> scenes;
    for (const std::string& kind : settings.kinds) {
        std::fprintf(stderr, "baking the %s scenes\n", kind.c_str());
        if (kind == "docking")
            for (const std::size_t atoms : settings.atoms)
                scenes.push_back(baker.docking(
                    static_cast<std::size_t>(std::llround(settings.work * static_cast<double>(atoms)))));
        if (kind == "surface") scenes.push_back(baker.surface());
        if (kind == "drilling") scenes.push_back(baker.drilling());
    }
    return scenes;
}

}  // namespace tact
