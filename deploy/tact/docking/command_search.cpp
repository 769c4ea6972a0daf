// tact search, tact refine: become the programs tact-search and tact-refine with the same arguments.
#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {
namespace {

void add_program(CLI::App& app, const char* name, const char* meaning) {
    CLI::App* const command = app.add_subcommand(name, meaning);
    command->set_help_flag();
    command->prefix_command();
    command->callback([command, name] { exec_program(std::string("tact-") + name, command->remaining()); });
}

}  // namespace

void add_search(CLI::App& app) {
    add_program(app, "search", "Find the places of structures in a density map (tact-search --help)");
    add_program(app, "refine",
                "Move structures to the best place nearby in a density map (tact-refine --help)");
}

}  // namespace tact::launch
