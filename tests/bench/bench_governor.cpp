#include "tests/bench/bench_governor.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "tests/bench/core_speed.hpp"
#include "tests/support/map_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using launch::Child;
using launch::ChildSettings;
using nlohmann::json;

constexpr auto kBakeTimeout = std::chrono::minutes(15);
constexpr auto kSpeedSample = std::chrono::milliseconds(300);  // beside each run

struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "tact-bench-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw StartupError("create a folder for the scenes in " + fs::temp_directory_path().string(),
                               "mkdtemp failed", "set TMPDIR to a writable folder");
        path = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

void run_program(const std::string& name, const std::vector<std::string>& arguments, const fs::path& log,
                 Duration most) {
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

struct BenchScene {
    std::string name;
    std::size_t atoms = 0;
    fs::path path;
    std::string knob;
    std::vector<double> levels;          // fixed levels
    std::vector<std::string> arguments;  // for tact run
};

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

// Writes the map of a baked scene to a file.
fs::path map_of(const Folder& folder, const SceneFile& scene) {
    fs::path file = folder.path / "map.mrc";
    if (!fs::exists(file)) launch::write_whole(file, map_file_bytes(read_grid(scene)));
    return file;
}

// Bakes the structure once to read its atoms, then bakes its copies.
BenchScene docking_scene(const GovernorBenchSettings& settings, const Folder& folder, std::size_t atoms) {
    const fs::path one = folder.path / "one.tact",
                   many = folder.path / ("docking-" + std::to_string(atoms) + ".tact");
    const fs::path log = folder.path / "bake.log";
    if (!fs::exists(one)) {
        if (settings.map.empty())
            run_program("tact-prep", {"demo", "dock", "-o", one.string()}, log, kBakeTimeout);
        else
            run_program("tact-prep",
                        {"dock", settings.map.string(), settings.structure.string(), "--resolution-a", "10",
                         "-o", one.string()},
                        log, kBakeTimeout);
    }
    const SceneFile scene = SceneFile::open(one);
    const Structure structure = read_structure(scene, 0);
    const fs::path copies = folder.path / "copies.cif";
    const std::size_t n = std::max<std::size_t>((atoms + structure.size() / 2) / structure.size(), 1);
    write_copies(structure, n, copies);
    const fs::path map = settings.map.empty() ? map_of(folder, scene) : settings.map;
    run_program("tact-prep",
                {"dock", map.string(), copies.string(), "--resolution-a", "10", "--vertices-max", "20000",
                 "-o", many.string()},
                log, kBakeTimeout);
    const SceneFile baked = SceneFile::open(many);
    return {.name = "docking",
            .atoms = n * structure.size(),
            .path = many,
            .knob = "docking.force",
            .levels = equal_levels(read_codebook(baked, 0).levels.size()),
            .arguments = {"--hand", "wander"}};
}

BenchScene surface_scene(const Folder& folder) {
    const fs::path path = folder.path / "surface.tact";
    run_program("tact-prep",
                {"demo", "touch", "--parts", "1000", "--tool", "block", "--tool-points", "1000",
                 "--no-forest", "--no-picture", "-o", path.string()},
                folder.path / "bake.log", kBakeTimeout);
    return {.name = "surface",
            .path = path,
            .knob = "surface.force",
            .levels = equal_levels(4, 0.05),
            .arguments = {"--hand", "stroke"}};
}

BenchScene drilling_scene(const Folder& folder) {
    const fs::path path = folder.path / "drilling.tact";
    run_program("tact-prep", {"demo", "drill", "--voxels", "512", "--voxel-mm", "0.1", "-o", path.string()},
                folder.path / "bake.log", kBakeTimeout);
    return {.name = "drilling",
            .path = path,
            .knob = "drilling.force",
            .levels = equal_levels(4),
            .arguments = {"--hand", "surgeon", "--burr-mm", "40", "--pedal", "always"}};
}

GovernorRun run_of(const json& report) {
    const auto number = [&report](const char* key) {
        return report.value(key, json(nullptr)).is_number() ? report[key].get<double>() : 0.0;
    };
    GovernorRun r;
    r.fault = report.value("armed_cycles", std::uint64_t{0}) == 0 || report.value("state", "") == "fault" ||
              !report["ended"].value("ok", false);
    r.miss_share = number("deadline_miss_share");
    r.error_n = number("force_error_n_p50");
    r.step_n = number("force_step_n_max");
    r.settled_s = number("level_settled_s");
    r.rate_hz = number("force_rate_hz");
    for (const auto& [name, path] : report["governor"]["paths"].items())
        if (path.value("haptic", false)) r.level = path.value("level", 0.0);
    return r;
}

GovernorRun run(const Folder& folder, const BenchScene& scene, double rate_hz, double seconds,
                const double* level) {
    const fs::path report = folder.path / "run.json", config = folder.path / "latch.toml";
    launch::write_whole(
        config, "[safety]\ntiming_latches = \"always\"\nlate_us_max = 1e6\nsample_age_us_max = 1e6\n");
    std::vector<std::string> arguments{"run",       scene.path.string(),     "--no-gui",  "--quiet",
                                       "--config",  config.string(),         "--session", "bench-governor",
                                       "--seconds", std::to_string(seconds), "--json",    report.string()};
    arguments.insert(arguments.end(), scene.arguments.begin(), scene.arguments.end());
    if (rate_hz > 0.0)
        arguments.insert(arguments.end(), {"--rate", std::to_string(rate_hz)});
    else
        arguments.emplace_back("--free-run");
    if (level != nullptr)
        arguments.insert(arguments.end(), {"--level", scene.knob + "=" + std::to_string(*level)});
    std::error_code ignored;
    fs::remove(report, ignored);
    run_program("tact", arguments, folder.path / "run.log",
                std::chrono::seconds(60) + std::chrono::milliseconds(std::llround(1e3 * seconds)));
    const json parsed = json::parse(launch::read_small(report), nullptr, false);
    if (parsed.is_discarded() || !parsed.contains("governor"))
        throw StartupError("run " + scene.name,
                           "the run failed: " + launch::read_small(folder.path / "run.log"),
                           "run the scene by hand: tact run SCENE");
    return run_of(parsed);
}

std::vector<BenchScene> scenes_of(const GovernorBenchSettings& settings, const Folder& folder) {
    std::vector<BenchScene> scenes;
    for (const std::string& name : settings.scenes) {
        std::fprintf(stderr, "baking the %s scenes\n", name.c_str());
        if (name == "docking")
            for (const std::size_t atoms : settings.atoms)
                scenes.push_back(docking_scene(settings, folder, atoms));
        if (name == "surface") scenes.push_back(surface_scene(folder));
        if (name == "drilling") scenes.push_back(drilling_scene(folder));
    }
    return scenes;
}

}  // namespace

bool valid_level(const GovernorRun& fixed) {
    return !fixed.fault && fixed.miss_share < GovernorBenchSettings::kMissShareMost;
}

GovernorRun median_of(const std::vector<GovernorRun>& runs) {
    GovernorRun median;
    for (const auto value : {&GovernorRun::miss_share, &GovernorRun::error_n, &GovernorRun::step_n,
                             &GovernorRun::level, &GovernorRun::settled_s, &GovernorRun::rate_hz}) {
        std::vector<double> values;
        values.reserve(runs.size());
        for (const GovernorRun& r : runs) values.push_back(r.*value);
        std::sort(values.begin(), values.end());
        median.*value = values[values.size() / 2];
    }
    median.fault = std::any_of(runs.begin(), runs.end(), [](const GovernorRun& r) { return r.fault; });
    return median;
}

json governor_row(const GovernorRun& adaptive, const std::vector<GovernorRun>& fixed) {
    using S = GovernorBenchSettings;
    const GovernorRun* best = nullptr;
    for (const GovernorRun& f : fixed) {
        if (!valid_level(f)) continue;
        if (best == nullptr || f.error_n < best->error_n) best = &f;
    }
    const auto at_most = [](double value, double most) { return value <= most + 1e-9; };
    const bool on_time = !adaptive.fault && adaptive.miss_share < S::kMissShareMost;
    const bool settled = at_most(adaptive.settled_s, S::kSettledMost_s);
    const bool accurate = best == nullptr || at_most(adaptive.error_n, S::kErrorRatioMost * best->error_n);
    const bool smooth = best == nullptr || at_most(adaptive.step_n, S::kStepRatioMost * best->step_n);
    return {{"force_rate_hz", adaptive.rate_hz},
            {"level", adaptive.level},
            {"fault", adaptive.fault},
            {"deadline_miss_share", adaptive.miss_share},
            {"level_settled_s", adaptive.settled_s},
            {"force_error_n_p50", adaptive.error_n},
            {"force_step_n_max", adaptive.step_n},
            {"best_fixed_level", best != nullptr ? json(best->level) : json(nullptr)},
            {"best_fixed_error_n_p50", best != nullptr ? json(best->error_n) : json(nullptr)},
            {"best_fixed_step_n_max", best != nullptr ? json(best->step_n) : json(nullptr)},
            {"on_time", on_time},
            {"settled", settled},
            {"accurate", accurate},
            {"smooth", smooth},
            {"passed", on_time && settled && accurate && smooth}};
}

json bench_governor(const GovernorBenchSettings& settings) {
    const Folder folder;
    json rows = json::array();
    bool passed = true, quiet = true;
    for (const BenchScene& scene : scenes_of(settings, folder)) {
        for (const double rate_hz : settings.rates_hz) {
            std::fprintf(stderr, "%s%s at %s\n", scene.name.c_str(),
                         scene.atoms > 0 ? (", " + std::to_string(scene.atoms) + " atoms,").c_str() : "",
                         rate_hz > 0.0 ? (std::to_string(std::lround(rate_hz)) + " Hz").c_str()
                                       : "a free-running rate");
            // Before, between and after the fixed levels: the machine's speed changes meanwhile.
            CoreSpeed speed;
            const auto run_at = [&](const double* level) {
                speed.sample(kSpeedSample);
                return run(folder, scene, rate_hz, settings.seconds, level);
            };
            std::vector<GovernorRun> adaptive{run_at(nullptr)}, fixed;
            int valid = 0;
            for (auto level = scene.levels.rbegin();
                 level != scene.levels.rend() && valid < GovernorBenchSettings::kValidLevels; ++level) {
                fixed.push_back(run_at(&*level));
                if (!valid_level(fixed.back())) continue;
                ++valid;
                adaptive.push_back(run_at(nullptr));
            }
            json row = {{"scene", scene.name},
                        {"atoms", scene.atoms > 0 ? json(scene.atoms) : json(nullptr)},
                        {"rate_hz", rate_hz > 0.0 ? json(rate_hz) : json("free")}};
            row.update(governor_row(median_of(adaptive), fixed));
            row["adaptive_runs"] = adaptive.size();
            row["core_speed_spread"] = speed.spread();
            row["core_quiet"] = speed.spread() <= CoreSpeed::kQuietSpread;
            quiet = quiet && row["core_quiet"].get<bool>();
            passed = passed && row["passed"].get<bool>();
            std::fprintf(stderr, "  %s\n", row.dump().c_str());
            rows.push_back(std::move(row));
        }
    }
    return {{"governor", rows}, {"governor_passed", passed}, {"governor_core_quiet", quiet}};
}

}  // namespace tact
