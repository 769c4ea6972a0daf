// tact dock MAP MODEL...: bakes the scene once, then runs it.
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/commands.hpp"

namespace tact::launch {
namespace {

constexpr PrepOption kDockPrep[] = {
    {"--contour", "LEVEL", "level of the drawn surface, in the map's unit"},
    {"--resolution-a", "A", "resolution of the map, where its header does not say it"},
    {"--force-map-resolution-a", "A",
     "feel the map smoothed to this, which draws a structure from farther away"},
    {"--vertices-max", "N", "most vertices of the drawn surface; 0: all"},
};

struct DockOptions {
    std::filesystem::path map;
    std::vector<std::filesystem::path> models;
    BakedRun baked;
};

int dock(const DockOptions& o) {
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
    auto* const command = app.add_subcommand("dock", "dock structures into a density map");
    const auto o = std::make_shared<DockOptions>();
    command->add_option("MAP", o->map, "density map: MRC, CCP4 or Situs, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_option("MODEL", o->models, "structures: PDB or mmCIF, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    add_baked_run_options(*command, kDockPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = dock(*o); });
}

}  // namespace tact::launch
