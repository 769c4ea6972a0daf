// tact record and tact replay: programs of their own, which take the words as they are.
#include <unistd.h>

#include "deploy/tact/child.hpp"
#include "deploy/tact/commands.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

// Becomes the program, so that its signals, its exit code and its --help are its own.
[[noreturn]] void become(const std::string& name, std::vector<std::string> words) {
    const std::filesystem::path program = find_program(name);
    words.insert(words.begin(), name);
    std::vector<char*> arguments;
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    throw StartupError("starting " + program.string(), last_error(), "build it again");
}

CLI::App* add_program(CLI::App& app, const char* word, const char* program, const char* what) {
    auto* const command = app.add_subcommand(word, what);
    command->set_help_flag();
    command->prefix_command();
    command->callback([command, program] { become(program, command->remaining()); });
    return command;
}

}  // namespace

void add_record(CLI::App& app) {
    add_program(app, "record", "tact-record",
                "every cycle of a run into an HDF5 file, crash-safe; --repair opens what a kill left");
    add_program(app, "replay", "tact-replay",
                "a recorded run again, by the same code in simulated time; compares every force to the bit");
}

}  // namespace tact::launch
