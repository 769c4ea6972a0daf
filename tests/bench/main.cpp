// tact-bench: measures the performance of a PC. `tact bench` starts it.
//
// Exit  0  done; 1  error; 2  wrong usage
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "tests/bench/bench_docking.hpp"
#include "tests/bench/bench_drilling.hpp"
#include "tests/bench/bench_governor.hpp"
#include "tests/bench/bench_ipc.hpp"
#include "tests/bench/bench_mesh.hpp"
#include "tests/bench/bench_particles.hpp"
#include "tests/bench/bench_prep.hpp"
#include "tests/bench/bench_servo.hpp"
#include "tests/bench/bench_surface.hpp"
#include "tests/bench/put_percentiles.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

struct Measure {
    const char* name;
    const char* help;
    json (*run)();
    bool only_named = false;  // true: not part of a default run, because it takes long or needs much memory
};

json ipc() {
    const IpcBench b = bench_ipc();
    json all;
    all["torn"] = b.torn;
    put_percentiles(all, "publish_ns", b.publish_ns);
    put_percentiles(all, "publish_contended_ns", b.publish_contended_ns);
    put_percentiles(all, "publish_tool_ns", b.publish_tool_ns);
    put_percentiles(all, "read_ns", b.read_ns);
    put_percentiles(all, "read_contended_ns", b.read_contended_ns);
    put_percentiles(all, "trace_push_ns", b.trace_push_ns);
    put_percentiles(all, "clock_ns", b.clock_ns);
    return all;
}

json servo() {
    const ServoBench b = bench_servo();
    return {{"lateness_us_p50", b.lateness.p50_us},
            {"lateness_us_p99", b.lateness.p99_us},
            {"lateness_us_p999", b.lateness.p999_us},
            {"lateness_us_max", b.lateness.max_us},
            {"lateness_asleep_us_p50", b.lateness_asleep.p50_us},
            {"lateness_asleep_us_p99", b.lateness_asleep.p99_us},
            {"lateness_asleep_us_p999", b.lateness_asleep.p999_us},
            {"lateness_asleep_us_max", b.lateness_asleep.max_us},
            {"lateness_cycles", b.lateness.cycles},
            {"lateness_overruns", b.overruns},
            {"lateness_fifo", b.fifo},
            {"lateness_core", b.core}};
}

json docking() {
    const DockingBench b = bench_docking();
    const MeshBench m = bench_mesh();
    json all{{"force_kernel", b.kernel},
             {"force_us_best_of_20_p50_n200", b.force_us_n200_best_of_20},
             {"force_us_best_of_20_p50_atoms100k", b.force_us_atoms100k_best_of_20},
             {"force_ns_per_point_n200", b.ns_per_point_n200},
             {"force_ns_per_point_atoms100k", b.ns_per_point_atoms},
             {"force_map_bytes", b.map_bytes},
             {"mesh_bytes_per_vertex", m.bytes_per_vertex}};
    put_percentiles(all, "force_us_n200", b.force_us_n200);
    put_percentiles(all, "force_us_atoms100k", b.force_us_atoms100k);
    put_percentiles(all, "jump_1m_ms", m.jump_ms);
    put_percentiles(all, "jump_1m_back_ms", m.jump_back_ms);
    put_percentiles(all, "jump_1m_back_walked_ms", m.jump_back_walked_ms);
    put_percentiles(all, "jump_1m_copy_ms", m.copy_ms);
    put_percentiles(all, "jump_1m_back_copy_ms", m.copy_back_ms);
    put_percentiles(all, "ns_per_vertex_contraction", m.ns_per_contraction);
    put_percentiles(all, "ns_per_vertex_split", m.ns_per_vertex_split);
    put_percentiles(all, "changes_1000_steps_ms", m.changes_ms);
    return all;
}

json docking_and_meshes() {
    json all = docking();
    all.update(bench_prep());
    return all;
}

json drilling_and_particles() {
    json all = bench_drilling();
    all.update(bench_particles_by_child());
    return all;
}

// Filled from the command line.
GovernorBenchSettings& governor_settings() {
    static GovernorBenchSettings settings;
    return settings;
}

json governor() { return bench_governor(governor_settings()); }

constexpr Measure kMeasures[] = {
    {"servo", "cycle lateness of a 1 kHz loop", &servo},
    {"docking",
     "time to compute one docking force at 1 kHz, to change the detail of a surface, and to simplify a mesh",
     &docking_and_meshes},
    {"surface",
     "time of one contact step at 1 kHz on surfaces of 92 480, 2 million and 10 million triangles; takes "
     "several minutes and 4 GB of memory",
     &bench_surface, true},
    {"drilling",
     "time of one drilling step (force and erosion) at 1 kHz for burr radii of 1 to 20 mm, and of one "
     "particle move; takes three minutes",
     &drilling_and_particles, true},
    {"governor",
     "deadline misses, force error and force steps of runs with adaptive and with fixed levels, at 1, 2 and "
     "4 kHz and free running; takes forty minutes",
     &governor, true},
    {"ipc", "time to publish and to read the state of one servo cycle", &ipc},
};

int bench(const std::vector<std::string>& wanted, bool as_json) {
    json all = json::object();
    for (const Measure& m : kMeasures) {
        const bool named = std::find(wanted.begin(), wanted.end(), m.name) != wanted.end();
        if (!named && (!wanted.empty() || m.only_named)) continue;
        const json numbers = m.run();
        if (!as_json) {
            std::printf("%s: %s\n", m.name, m.help);
            for (const auto& [key, value] : numbers.items())
                std::printf("  %-40s %s\n", key.c_str(),
                            value.is_number_float() ? (std::to_string(value.get<double>())).c_str()
                                                    : value.dump().c_str());
            std::fflush(stdout);
        }
        all.update(numbers);  // keys are unique
    }
    if (as_json) std::printf("%s\n", all.dump(2).c_str());
    return 0;
}

void describe(CLI::App& app, int& exit_code) {
    CLI::App* const command = &app;
    const auto wanted = std::make_shared<std::vector<std::string>>();
    const auto as_json = std::make_shared<bool>(false);
    std::vector<std::string> names;
    std::string help =
        "Measurements to run; default: all except surface, drilling and governor. Percentiles (p50, p99, "
        "p999) and max describe a single pass; the keys of the minimum over three passes contain best_of_3.";
    for (const Measure& m : kMeasures) {
        names.emplace_back(m.name);
        help += std::string(" ") + m.name + ": " + m.help + ".";
    }
    command->add_option("WHAT", *wanted, help)->check(CLI::IsMember(names));
    command->add_flag("--json", *as_json, "Print as JSON");
    const auto work = std::make_shared<SurfaceWork>();
    auto* const group =
        command->add_option_group("Surface", "Measure contact with your own mesh; prints CSV");
    auto* const mesh = group
                           ->add_option("--mesh", work->mesh,
                                        "Triangle mesh: PLY, OBJ, STL or OFF, optionally compressed (.gz)")
                           ->check(CLI::ExistingFile);
    auto* const path = group
                           ->add_option("--trajectory", work->trajectory,
                                        "Tool positions: text file, one line x y z per millisecond, in the "
                                        "unit of the mesh (--mesh) or in mm (--volume)")
                           ->check(CLI::ExistingFile);
    mesh->needs(path);
    group->add_option("--unit", work->unit, "Unit of length of the mesh and the trajectory (a: angstrom)")
        ->check(CLI::IsMember({"m", "cm", "mm", "um", "nm", "a"}))
        ->capture_default_str();
    group->add_option("--tool-radius-mm", work->radius_mm, "Radius of the tool, a ball (mm); 0: a point")
        ->check(CLI::Range(0.0, 50.0))
        ->capture_default_str();
    const auto drilling = std::make_shared<DrillingWork>();
    auto* const bone =
        command->add_option_group("Drilling", "Measure drilling in your own volume; prints CSV");
    auto* const volume =
        bone->add_option("--volume", drilling->volume,
                         "Bone volume: raw file, one byte per voxel, x fastest; 0: no bone, 255: solid bone")
            ->check(CLI::ExistingFile)
            ->excludes(mesh);
    bone->add_option("--size", drilling->size, "Size of the bone volume along x, y and z (voxels)")
        ->expected(3)
        ->check(CLI::Range(1, 2048))
        ->capture_default_str();
    bone->add_option("--voxel-mm", drilling->voxel_mm, "Edge length of a voxel (mm)")
        ->check(CLI::Range(0.01, 10.0))
        ->capture_default_str();
    bone->add_option("--burr-radius-mm", drilling->radius_mm, "Burr radius (mm)")
        ->check(CLI::Range(0.1, 50.0))
        ->capture_default_str();
    GovernorBenchSettings& governed = governor_settings();
    auto* const runs = command->add_option_group("Governor", "Settings of the governor measurement");
    auto* const map = runs->add_option("--map", governed.scenes.map,
                                       "Density map for the docking scenes; default: the map of the demo")
                          ->check(CLI::ExistingFile);
    auto* const structure = runs->add_option("--structure", governed.scenes.structure,
                                             "Structure for the docking scenes, copied to reach --atoms; "
                                             "default: the structure of the demo")
                                ->check(CLI::ExistingFile)
                                ->needs(map);
    map->needs(structure);
    runs->add_option("--scene", governed.scenes.kinds, "Scenes of the governor measurement")
        ->check(CLI::IsMember({"docking", "surface", "drilling"}))
        ->capture_default_str();
    runs->add_option("--atoms", governed.scenes.atoms, "Number of atoms of each docking scene")
        ->check(CLI::Range(1000, 2'000'000))
        ->capture_default_str();
    runs->add_option("--work", governed.scenes.work,
                     "Work of the scenes relative to the standard ones, by fewer atoms, tool points and "
                     "voxels: for slow processors")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    runs->add_option("--folder", governed.scenes.folder,
                     "Folder that keeps the scenes; those that are there already are used as they are; "
                     "default: a temporary folder");
    runs->add_flag("--bake-only", governed.bake_only, "Bake the scenes into --folder and measure nothing")
        ->needs("--folder");
    runs->add_option("--rate", governed.rates_hz,
                     "Servo rates of the governor measurement (Hz); 0: free running")
        ->check(CLI::Range(0.0, 20'000.0))
        ->capture_default_str();
    runs->add_option("--seconds", governed.seconds, "Duration of each adaptive run (s)")
        ->check(CLI::Range(1.0, 600.0))
        ->capture_default_str();
    command->callback([=, &exit_code] {
        if (*volume && !*path)
            throw CLI::ValidationError(
                "--volume", "needs --trajectory: one line x y z of the burr centre per millisecond, in mm");
        if (*path && !*mesh && !*volume)
            throw CLI::ValidationError("--trajectory", "needs --mesh or --volume");
        if (*volume) {
            drilling->trajectory = work->trajectory;
            std::fputs(drilling_work_csv(*drilling).c_str(), stdout);
            exit_code = 0;
            return;
        }
        if (work->mesh.empty()) {
            exit_code = bench(*wanted, *as_json);
            return;
        }
        std::fputs(surface_work_csv(*work).c_str(), stdout);
        exit_code = 0;
    });
}

}  // namespace
}  // namespace tact::launch

int main(int argc, char** argv) {
    CLI::App app{"tact-bench: measures the performance of this machine"};
    app.set_version_flag("--version", tact::program_version("tact-bench"));
    app.footer("Exit codes: 0 done; 1 error; 2 wrong usage.");
    int exit_code = 0;
    tact::launch::describe(app, exit_code);
    if (const auto answered = tact::manual::answer(app, "tact-bench", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-bench: %s\n", e.what());
        return 1;
    }
    return exit_code;
}
