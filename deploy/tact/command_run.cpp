// tact run SCENE: runs a scene that tact-prep baked.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"

namespace tact::launch {

void add_run(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("run", "Run a baked scene");
    const auto options = std::make_shared<RunOptions>();
    const auto scene = std::make_shared<std::filesystem::path>();
    command->add_option("SCENE", *scene, "Scene file written by tact-prep, or a session saved in the window")
        ->required()
        ->check(CLI::ExistingFile);
    add_run_options(*command, *options);
    command->callback([=, &exit_code] { exit_code = run_scene(*scene, *options); });
}

}  // namespace tact::launch
