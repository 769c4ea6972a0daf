// tact certify: becomes the program tact-certify with the same arguments.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_certify(CLI::App& app) {
    auto* const command = app.add_subcommand(
        "certify", "Compare the forces of a scene with an independent reference (tact-certify --help)");
    command->set_help_flag();
    command->prefix_command();
    command->callback([command] { exec_program("tact-certify", command->remaining()); });
}

}  // namespace tact::launch
