// tact bench: a program of its own, which takes the words as they are.
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
