// tact touch MESH: bakes the surface once, then runs it.
// tact demo touch: a hand strokes a rough terrain, or a rough or smooth sphere.
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/surface/surface.hpp"
#include "deploy/tact/surface/tool_options.hpp"

namespace tact::launch {
namespace {

constexpr PassedOption kTouchPrep[] = {
    {"--unit", "m|cm|mm|um|nm|a", "Unit of length in the mesh file (a: angstrom); default mm"},
    {"--up", "y|z", "Axis of the mesh file that points up; default y"},
    {"--size-mm", "MM", "Length of the mesh's diagonal in the workspace (mm); default 150"},
    {"--vertices-max", "N", "Maximum number of vertices of the drawn surface; 0: no limit; default 500000"},
};

constexpr PassedOption kTouchController[] = {
    {"--tool-radius-mm", "MM", "Radius of the ball that touches the surface (mm); 0: a point"},
    {"--stiffness", "N/M", "Stiffness of the surface (N/m)"},
    {"--friction", "MU", "Friction coefficient of the surface, before the tool slides"},
    {"--dynamic-friction", "MU",
     "Friction coefficient while the tool slides, at most that of --friction; default: equal"},
    {"--mode", "off-brute|off-tree|chr",
     "Contact search on the surface; chr: refined around the tool, which saves the servo no time"},
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
    auto* const command = app.add_subcommand("touch", "Feel the surface of a triangle mesh");
    const auto o = std::make_shared<TouchOptions>();
    command->add_option("MESH", o->mesh, "Triangle mesh: PLY, OBJ, STL or OFF, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    o->tool = add_tool_options(*command);
    add_baked_run_options(*command, kTouchPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = touch(*o); });
}

void add_touch_demo(CLI::App& demo, int& exit_code) {
    auto* const command = demo.add_subcommand("touch", "A hand strokes a rough terrain or a dense sphere");
    const auto baked = std::make_shared<BakedRun>();
    const auto shape = std::make_shared<std::string>("terrain");
    command->add_option("--shape", *shape, "Synthetic surface: terrain, sphere (rough) or smooth-sphere")
        ->check(CLI::IsMember({"terrain", "sphere", "smooth-sphere"}))
        ->capture_default_str();
    const auto tool = add_tool_options(*command);
    add_demo_run_options(*command, *baked);
    command->callback([baked, shape, tool, &exit_code] {
        let_the_hand_stroke(baked->run);
        BakeRequest request{.inputs = {}, .words = {"demo", "touch", "--shape", *shape}, .options = {}};
        tool->add_to(request);
        exit_code = bake_and_run(request, *baked);
    });
}

std::span<const PassedOption> surface_controller_options() { return kTouchController; }

void let_the_hand_stroke(RunOptions& options) {
    if (hand_is_free(options)) options.add_for_scene({"--hand", "stroke"});
}

}  // namespace tact::launch
