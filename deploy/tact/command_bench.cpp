// tact bench: becomes the program tact-bench with the same arguments.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_bench(CLI::App& app) {
    auto* const command =
        app.add_subcommand("bench", "Measure the performance of this machine (tact-bench --help)");
    command->set_help_flag();
    command->prefix_command();
    command->callback([command] { exec_program("tact-bench", command->remaining()); });
}

}  // namespace tact::launch
