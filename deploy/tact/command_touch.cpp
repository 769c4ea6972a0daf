// tact touch MESH: bakes the surface once, then runs it.
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/commands.hpp"
#include "deploy/tact/tool_options.hpp"

namespace tact::launch {
namespace {

constexpr PrepOption kTouchPrep[] = {
    {"--unit", "m|cm|mm|um|nm|a", "unit of lengths in the file; a: angstrom; default mm"},
    {"--up", "y|z", "axis of the file that points up; default y"},
    {"--size-mm", "MM", "length of the mesh's diagonal in the hand's space; default 150"},
    {"--vertices-max", "N", "most vertices of the drawn surface; 0: all"},
};

struct TouchOptions {
    std::filesystem::path mesh;
    std::shared_ptr<ToolOptions> tool;
    BakedRun baked;
};

int touch(TouchOptions& o) {
    BakeRequest request{
        .inputs = {o.mesh}, .words = {"touch", std::filesystem::absolute(o.mesh)}, .options = o.baked.prep};
    o.tool->add_to(request);
    let_the_hand_stroke(o.baked.run);
    return bake_and_run(request, o.baked);
}

}  // namespace

void add_touch(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("touch", "feel the surface of a triangle mesh");
    const auto o = std::make_shared<TouchOptions>();
    command->add_option("MESH", o->mesh, "triangle mesh: PLY, OBJ, STL or OFF, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    o->tool = add_tool_options(*command);
    add_baked_run_options(*command, kTouchPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = touch(*o); });
}

}  // namespace tact::launch
