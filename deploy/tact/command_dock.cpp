// tact dock MAP MODEL...: bakes the scene once, then runs it.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {
namespace {

struct DockOptions {
    RunOptions run;
    std::filesystem::path map;
    std::vector<std::filesystem::path> models;
    std::vector<std::string> prep;
    bool bake_only = false;
};

void dock(const DockOptions& o, int& exit_code) {
    BakeRequest request{
        .inputs = {o.map}, .words = {"dock", std::filesystem::absolute(o.map)}, .options = o.prep};
    for (const auto& m : o.models) {
        request.inputs.push_back(m);
        request.words.push_back(std::filesystem::absolute(m));
    }
    const auto scene = baked_scene(request);
    if (scene.empty()) {
        exit_code = 130;
    } else if (o.bake_only) {
        std::puts(scene.c_str());
        exit_code = 0;
    } else {
        exit_code = run_scene(scene, o.run);
    }
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
    command->add_flag("--bake-only", o->bake_only, "bake the scene, print its path and stop");
    for (const auto& [name, type, help] :
         {std::tuple("--contour", "LEVEL", "level of the drawn surface, in the map's unit"),
          std::tuple("--resolution-a", "A", "resolution of the map, where its header does not say it"),
          std::tuple("--felt-resolution-a", "A",
                     "feel the map smoothed to this, which draws a structure from farther away"),
          std::tuple("--vertices-max", "N", "of the drawn surface")}) {
        command
            ->add_option_function<std::string>(
                name,
                [o, n = std::string(name)](const std::string& v) {
                    o->prep.insert(o->prep.end(), {n, v});
                },
                help)
            ->type_name(type);
    }
    add_run_options(*command, o->run);
    command->callback([o, &exit_code] { dock(*o, exit_code); });
}

}  // namespace tact::launch
