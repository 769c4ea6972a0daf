// tact reproduce: the seeds' figures on this machine.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/reproduce/docking.hpp"
#include "deploy/tact/reproduce/drilling.hpp"
#include "deploy/tact/reproduce/surface.hpp"

namespace tact::launch {

namespace {

void add_docking(CLI::App& reproduce, int& exit_code, const char* name, const char* about, bool meshes) {
    auto* const command = reproduce.add_subcommand(name, about);
    const auto e = std::make_shared<DockingExperiment>();
    e->with_meshes = meshes;
    command->add_option("--out", e->out, "folder for CSV, PNG and JSON")->required();
    command->add_option("--core", e->rates.core.core, "the core that all share; -1: the last")
        ->check(CLI::Range(-1, 1023));
    command->add_option("--fps-max", e->rates.core.fps_max, "pictures a second, at most")
        ->check(CLI::Range(1.0, 240.0))
        ->capture_default_str();
    command->add_option("--law", e->rates.law, "law of the governor in the adapted runs")
        ->check(CLI::IsMember({"elastic", "sensitus"}))
        ->capture_default_str();
    command
        ->add_option("--goal", e->rates.goal_hz,
                     "force rate to hold under load, in Hz; 0: from a measurement")
        ->check(CLI::Range(0.0, 1e6));
    command->add_flag("--quick", e->rates.quick, "seconds instead of a minute; shows that it works");
    command->callback([e, &exit_code] { exit_code = reproduce_docking(*e); });
}

void add_surface(CLI::App& reproduce, int& exit_code) {
    auto* const command =
        reproduce.add_subcommand("surface", "the surface seed's table 1, and beyond; minutes and 4 GB");
    const auto e = std::make_shared<SurfaceExperiment>();
    command->add_option("--out", e->out, "folder for CSV, PNG and JSON")->required();
    command->add_option("--mesh", e->meshes, "meshes to touch, instead of synthetic ones")
        ->check(CLI::ExistingFile);
    command->add_option("--unit", e->unit, "unit of lengths in these files")->capture_default_str();
    command->add_option("--triangles-max", e->triangles_max, "most triangles of the synthetic meshes")
        ->capture_default_str();
    command->add_flag("--quick", e->quick, "seconds instead of minutes; shows that it works");
    command->callback([e, &exit_code] { exit_code = reproduce_surface(*e); });
}

void add_drilling(CLI::App& reproduce, int& exit_code) {
    auto* const command = reproduce.add_subcommand("drilling", "the drilling seed's figures 1 to 4");
    const auto e = std::make_shared<DrillingExperiment>();
    command->add_option("--out", e->out, "folder for CSV, PNG and JSON")->required();
    command->add_flag("--quick", e->quick, "fewer places; shows that it works");
    command->add_flag("!--no-pictures", e->pictures,
                      "leave figure 1 out, a run of half a minute with a window");
    command->callback([e, &exit_code] { exit_code = reproduce_drilling(*e); });
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
    auto* const reproduce =
        app.add_subcommand("reproduce", "run the seeds' experiments again, on this machine");
    reproduce->require_subcommand(1);
    add_docking(*reproduce, exit_code, "docking", "the docking seed's figures 3 to 8", true);
    add_docking(*reproduce, exit_code, "governor",
                "of those, the force rate with and without the law, with and without an external load",
                false);
    add_surface(*reproduce, exit_code);
    add_drilling(*reproduce, exit_code);
}

}  // namespace tact::launch
