// tact touch MESH: bakes the surface once, then runs it.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"
#include "deploy/tact/tool_options.hpp"

namespace tact::launch {
namespace {

struct TouchOptions {
    RunOptions run;
    std::filesystem::path mesh;
    std::vector<std::string> prep;
    std::shared_ptr<ToolOptions> tool;
    bool bake_only = false;
};

void touch(TouchOptions& o, int& exit_code) {
    BakeRequest request{
        .inputs = {o.mesh}, .words = {"touch", std::filesystem::absolute(o.mesh)}, .options = o.prep};
    o.tool->add_to(request);
    const auto scene = baked_scene(request);
    if (scene.empty()) {
        exit_code = 130;
    } else if (o.bake_only) {
        std::puts(scene.c_str());
        exit_code = 0;
    } else {
        let_the_hand_stroke(o.run);
        exit_code = run_scene(scene, o.run);
    }
}

}  // namespace

void add_touch(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("touch", "feel the surface of a triangle mesh");
    const auto o = std::make_shared<TouchOptions>();
    command->add_option("MESH", o->mesh, "triangle mesh: PLY, OBJ, STL or OFF, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_flag("--bake-only", o->bake_only, "bake the scene, print its path and stop");
    for (const auto& [name, type, help] :
         {std::tuple("--unit", "UNIT", "of the file: m, cm, mm (default), um, nm or a (angstrom)"),
          std::tuple("--up", "AXIS", "of the file that points up: y (default) or z"),
          std::tuple("--size-mm", "MM", "how wide its diagonal is in the hand's space; default 150"),
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
    o->tool = add_tool_options(*command);
    add_run_options(*command, o->run);
    command->callback([o, &exit_code] { touch(*o, exit_code); });
}

}  // namespace tact::launch
