// tact-reproduce: reproduces the published experiments on this machine. `tact reproduce` starts it.
//
// Exit  0  done; 1  error; 2  wrong usage
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "tests/reproduce/docking.hpp"
#include "tests/reproduce/drilling.hpp"
#include "tests/reproduce/fitting.hpp"
#include "tests/reproduce/surface.hpp"

namespace tact::launch {

namespace {

void add_docking(CLI::App& reproduce, int& exit_code, const char* name, const char* about, bool meshes) {
    auto* const command = reproduce.add_subcommand(name, about);
    const auto e = std::make_shared<DockingExperiment>();
    e->with_meshes = meshes;
    command->add_option("--out", e->out, "Folder for CSV, PNG and JSON files")->required();
    command
        ->add_option("--core", e->rates.core.core,
                     "Processor core shared by all processes; -1: the last core; default -1")
        ->check(CLI::Range(-1, 1023));
    command->add_option("--fps-max", e->rates.core.fps_max, "Maximum frame rate (frames/s)")
        ->check(CLI::Range(1.0, 240.0))
        ->capture_default_str();
    command->add_option("--law", e->rates.law, "Governor law in the adaptive runs")
        ->check(CLI::IsMember({"elastic", "sensitus"}))
        ->capture_default_str();
    command
        ->add_option("--goal", e->rates.goal_hz,
                     "Goal of the force rate under load (Hz); 0: derived from a measurement; default 0")
        ->check(CLI::Range(0.0, 1e6));
    command
        ->add_option(
            "--pairs", e->rates.pairs,
            "Pairs of runs of the law and of the published one under load, taking turns; 20 s each run")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_flag("--quick", e->rates.quick, "Short run of a few seconds, as a check");
    command->callback([e, &exit_code] { exit_code = reproduce_docking(*e); });
}

void add_surface(CLI::App& reproduce, int& exit_code) {
    auto* const command =
        reproduce.add_subcommand("surface",
                                 "Reproduce table 1 of the surface paper with meshes of up to 10 million "
                                 "triangles; takes several minutes and 4 GB of memory");
    const auto e = std::make_shared<SurfaceExperiment>();
    command->add_option("--out", e->out, "Folder for CSV, PNG and JSON files")->required();
    command->add_option("--mesh", e->meshes, "Mesh files to measure; default: synthetic meshes")
        ->check(CLI::ExistingFile);
    command->add_option("--unit", e->unit, "Unit of length of the mesh files")->capture_default_str();
    command
        ->add_option("--triangles-max", e->triangles_max,
                     "Maximum number of triangles of the synthetic meshes")
        ->capture_default_str();
    command->add_flag("--quick", e->quick, "Short run of a few seconds, as a check");
    command->callback([e, &exit_code] { exit_code = reproduce_surface(*e); });
}

void add_drilling(CLI::App& reproduce, int& exit_code) {
    auto* const command =
        reproduce.add_subcommand("drilling", "Reproduce figures 1 to 4 of the drilling paper");
    const auto e = std::make_shared<DrillingExperiment>();
    command->add_option("--out", e->out, "Folder for CSV, PNG and JSON files")->required();
    command->add_flag("--quick", e->quick, "Short run with fewer positions, as a check");
    command->add_flag("!--no-pictures", e->pictures,
                      "Skip figure 1, which needs a run of half a minute with a window");
    command->callback([e, &exit_code] { exit_code = reproduce_drilling(*e); });
}

void add_fitting(CLI::App& reproduce, int& exit_code) {
    auto* const command = reproduce.add_subcommand(
        "fitting", "Count how often search and refinement find the right places in maps, from random starts");
    const auto e = std::make_shared<FittingExperiment>();
    command->add_option("--out", e->out, "Folder for PNG and JSON files")->required();
    command
        ->add_option("--pair", e->pairs,
                     "MAP,RESOLUTION,MODEL[,MODEL...]: a map, its resolution (angstrom), and structures at "
                     "their right "
                     "places. Repeat for several; default: a synthetic ring")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->expected(1);
    command->add_option("--only", e->only, "Only this test")
        ->check(CLI::IsMember({"search", "refine", "hand", "bend", "together"}));
    command->add_option("--starts", e->starts, "Number of random starts of each row")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--seed", e->seed, "Seed of the first start")->capture_default_str();
    command->add_flag("--quick", e->quick, "One start of one structure, as a check");
    command->callback([e, &exit_code] { exit_code = reproduce_fitting(*e); });
}

}  // namespace
}  // namespace tact::launch

int main(int argc, char** argv) {
    using namespace tact::launch;
    CLI::App app{"tact-reproduce: reproduces the published experiments on this machine"};
    app.set_version_flag("--version", tact::program_version("tact-reproduce"));
    app.footer("Exit codes: 0 done; 1 error; 2 wrong usage.");
    app.require_subcommand(1);
    int exit_code = 0;
    add_docking(app, exit_code, "docking", "Reproduce figures 3 to 8 of the docking paper", true);
    add_docking(app, exit_code, "governor",
                "Reproduce the force rates of the docking paper, with and without the governor, with and "
                "without external load",
                false);
    add_fitting(app, exit_code);
    add_surface(app, exit_code);
    add_drilling(app, exit_code);
    if (const auto answered = tact::manual::answer(app, "tact-reproduce", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "tact-reproduce: %s\n", e.what());
        return 1;
    }
    return exit_code;
}
