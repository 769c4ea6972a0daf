// tact record: a program of its own, which takes the words as they are.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_record(CLI::App& app) {
    auto* const command = app.add_subcommand(
        "record", "every cycle of a run into an HDF5 file, crash-safe; or its last seconds; repair, tables");
    command->set_help_flag();
    command->prefix_command();
    command->callback([command] { exec_program("tact-record", command->remaining()); });
}

}  // namespace tact::launch
