// tact calibrate --stage lab.toml: measures stereo screen, eyes and workspace step by step and writes them to that
// file.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {

void add_calibrate(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "calibrate",
        "Measure the positions of stereo screen, eyes and workspace, and write them to --stage FILE.toml");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->callback([options, &exit_code] {
        options->visual.emplace_back("--calibrate");
        // Devices are read as in any run, but the force scale is 0: nothing pushes the hand while it measures.
        if (!options->has_controller_option("--force-scale"))
            options->controller.insert(options->controller.end(), {"--force-scale", "0"});
        const auto scene = baked_scene(
            {.inputs = {}, .words = {"demo", "touch", "--shape", "smooth-sphere"}, .options = {}});
        exit_code = scene.empty() ? 130 : run_scene(scene, *options);
    });
}

}  // namespace tact::launch
