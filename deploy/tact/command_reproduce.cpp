// tact reproduce: becomes the program tact-reproduce with the same arguments.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_reproduce(CLI::App& app) {
    auto* const command = app.add_subcommand(
        "reproduce", "Reproduce the published experiments on this machine (tact-reproduce --help)");
    command->set_help_flag();
    command->prefix_command();
    command->callback([command] { exec_program("tact-reproduce", command->remaining()); });
}

}  // namespace tact::launch
