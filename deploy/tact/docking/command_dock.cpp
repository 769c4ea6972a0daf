// tact dock MAP MODEL...: bakes the scene once, then runs it.
// tact dock SCENE MODEL...: bakes it again with more structures, then runs it.
// tact demo dock: the force draws a synthetic ring of six from a displaced start to its place in the 12 Å map.
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/docking/add_structures.hpp"
#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/run.hpp"

namespace tact::launch {
namespace {

constexpr PassedOption kDockPrep[] = {
    {"--contour", "LEVEL",
     "Contour level of the drawn surface, in the map's unit; default: chosen from the histogram"},
    {"--resolution-a", "A",
     "Resolution of the map (angstrom), as published with it; required unless half-maps are given"},
    {"--half-map", "FILE",
     "One of the two half-maps, given twice: the resolution is where their Fourier shell correlation is "
     "0.143",
     true},
    {"--mask", "FILE", "Map that is 1 inside and 0 outside: density outside becomes background", true},
    {"--force-map-resolution-a", "A",
     "Resolution (angstrom) to which the force map is smoothed, so that it attracts a structure from farther "
     "away; default: not smoothed"},
    {"--vertices-max", "N", "Maximum number of vertices of the drawn surface; 0: no limit; default 1000000"},
    {"--modes", "N",
     "Normal modes of each structure, along which it can bend; 12 are a good start; default 0"},
};

constexpr PassedOption kDockController[] = {
    {"--start-offset-a", "A",
     "Start distance of the first structure from the position in its file (angstrom)"},
    {"--start-rotation-deg", "DEG",
     "Start rotation of the first structure from the orientation in its file (degrees)"},
    {"--copies", "N", "Number of bodies of the first structure; the copies are placed around the map"},
    {"--flexible", "on|off",
     "on: the body in the hand bends along the normal modes of its structure; needs --modes in the bake"},
    {"--poses", "FILE.json", "Start poses of the bodies, from the report of an earlier run (JSON)"},
};

struct DockOptions {
    std::filesystem::path map;
    std::vector<std::filesystem::path> models;
    BakedRun baked;
};

int dock(const DockOptions& o) {
    if (is_scene_or_session(o.map)) return dock_into_scene(o.map, o.models, o.baked);
    BakeRequest request{
        .inputs = {o.map}, .words = {"dock", std::filesystem::absolute(o.map)}, .options = o.baked.prep};
    for (const auto& m : o.models) {
        request.inputs.push_back(m);
        request.words.push_back(std::filesystem::absolute(m));
    }
    return bake_and_run(request, o.baked);
}

}  // namespace

void add_dock(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("dock", "Dock structures into a density map");
    const auto o = std::make_shared<DockOptions>();
    command
        ->add_option(
            "MAP", o->map,
            "Density map: MRC, CCP4 or Situs, also .gz; or a docking scene or session that MODEL is added to")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_option("MODEL", o->models, "Structures: PDB or mmCIF, also .gz; one body per file")
        ->required()
        ->check(CLI::ExistingFile);
    add_baked_run_options(*command, kDockPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = dock(*o); });
}

void add_docking_commands(CLI::App& app, int& exit_code) {
    add_dock(app, exit_code);
    add_eval(app, exit_code);
    add_search(app);
}

void add_docking_demo(CLI::App& demo, int& exit_code) {
    auto* const command =
        demo.add_subcommand("dock", "The force draws a ring of six subunits to its position in a 12 A map");
    const auto baked = std::make_shared<BakedRun>();
    add_demo_run_options(*command, *baked);
    command->callback([baked, &exit_code] {
        RunOptions& options = baked->run;
        // Far enough that the motion is visible, near enough that the force draws the ring back.
        for (const auto& [name, value] :
             {std::pair("--start-offset-a", "15"), std::pair("--start-rotation-deg", "30")})
            if (!options.has_controller_option(name) && !options.has_controller_option("--poses"))
                options.add_for_scene({name, value});
        exit_code = bake_and_run({.inputs = {}, .words = {"demo", "dock"}, .options = {}}, *baked);
    });
}

std::span<const PassedOption> docking_controller_options() { return kDockController; }

}  // namespace tact::launch
