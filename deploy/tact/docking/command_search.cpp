// tact search, tact refine: become tact-prep with the same arguments.
#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {
namespace {

void add_prep_command(CLI::App& app, const char* name, const char* meaning) {
    CLI::App* const command = app.add_subcommand(name, meaning);
    command->set_help_flag();
    command->prefix_command();
    command->callback([command, name] {
        std::vector<std::string> words = command->remaining();
        words.insert(words.begin(), name);
        exec_program("tact-prep", words);
    });
}

}  // namespace

void add_search(CLI::App& app) {
    add_prep_command(app, "search",
                     "Find the places of structures in a density map, without a hand (tact search --help)");
    add_prep_command(app, "refine",
                     "Move structures to the nearest optimum of their fit to a map (tact refine --help)");
}

}  // namespace tact::launch
