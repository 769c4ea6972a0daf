// tact record: becomes the program tact-record with the same arguments.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_record(CLI::App& app) {
    auto* const command = app.add_subcommand("record",
                                             "Record every servo cycle of a run, or its last seconds; repair "
                                             "and convert recordings (tact-record)");
    command->set_help_flag();
    command->prefix_command();
    command->callback([command] { exec_program("tact-record", command->remaining()); });
}

}  // namespace tact::launch
