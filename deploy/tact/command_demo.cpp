// tact demo dock: a synthetic ring of six, started away from its place, is drawn into its 12 A map.
// tact demo drill: a surgeon opens the mastoid of a synthetic temporal bone, a second hand sucks.
// tact demo touch: a hand strokes a rough terrain, or a rough or smooth sphere.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"
#include "deploy/tact/tool_options.hpp"

namespace tact::launch {
void add_demo(CLI::App& app, int& exit_code) {
    auto* const demo = app.add_subcommand("demo", "show what Tact does, without files or devices");
    demo->require_subcommand(1);
    auto* const dock =
        demo->add_subcommand("dock", "a ring of six is drawn by the force to its place in a 12 A map");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*dock, *options);
    dock->callback([options, &exit_code] {
        // Far enough to be seen moving, near enough to be drawn back (tact dock on real data uses the same
        // start).
        for (const auto& [name, value] :
             {std::pair("--start-offset-a", "15"), std::pair("--start-rotation-deg", "30")})
            if (!options->has_controller_option(name) && !options->has_controller_option("--poses"))
                options->add_for_scene({name, value});
        const auto scene = baked_scene({.inputs = {}, .words = {"demo", "dock"}, .options = {}});
        exit_code = scene.empty() ? 130 : run_scene(scene, *options);
    });
    auto* const drill =
        demo->add_subcommand("drill", "two hands open a temporal bone with a burr and a suction tube");
    const auto drill_options = std::make_shared<RunOptions>();
    const auto voxels = std::make_shared<std::string>("256");
    drill->add_option("--voxels", *voxels, "voxels of the bone along each axis")->capture_default_str();
    add_run_options(*drill, *drill_options);
    drill->callback([drill_options, voxels, &exit_code] {
        let_the_hands_drill(*drill_options);
        // Behind the ear canal, over the antrum.
        if (drill_options->has_controller_option("surgeon") &&
            !drill_options->has_controller_option("--hand-at-mm"))
            drill_options->add_for_scene({"--hand-at-mm", kMastoidMm});
        const auto scene =
            baked_scene({.inputs = {}, .words = {"demo", "drill", "--voxels", *voxels}, .options = {}});
        exit_code = scene.empty() ? 130 : run_scene(scene, *drill_options);
    });
    auto* const touch = demo->add_subcommand("touch", "a rough terrain, or a dense sphere, is felt");
    const auto touch_options = std::make_shared<RunOptions>();
    const auto shape = std::make_shared<std::string>("terrain");
    touch->add_option("--shape", *shape, "terrain, sphere (rough) or smooth-sphere")
        ->check(CLI::IsMember({"terrain", "sphere", "smooth-sphere"}))
        ->capture_default_str();
    const auto tool = add_tool_options(*touch);
    add_run_options(*touch, *touch_options);
    touch->callback([touch_options, shape, tool, &exit_code] {
        let_the_hand_stroke(*touch_options);
        BakeRequest request{.inputs = {}, .words = {"demo", "touch", "--shape", *shape}, .options = {}};
        tool->add_to(request);
        const auto scene = baked_scene(request);
        exit_code = scene.empty() ? 130 : run_scene(scene, *touch_options);
    });
}

}  // namespace tact::launch
