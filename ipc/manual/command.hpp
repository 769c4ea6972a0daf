// The data that --help prints about a program or one of its commands.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace tact::manual {

struct Argument {
    std::vector<std::string> names;  // of an option, with dashes; of a positional, one word in capitals
    std::string value;               // placeholder of the value; empty: a flag
    std::string type;                // as in the parser, without its checks
    std::string help, low, high, default_value;
    std::vector<std::string> choices, needs, excludes;
    bool required = false, repeated = false, positional = false;
    bool number = false, folder = false;
};

struct Group {
    std::string title, about;
    std::vector<Argument> arguments;
    std::vector<std::string> one_of;  // exactly one of these is required
};

struct Command {
    std::vector<std::string> words;  // "tact", "demo", "dock"
    std::string about, footer, version;
    std::vector<Argument> positionals;  // including those of groups
    std::vector<Group> groups;          // groups of options; the first has no title
    std::vector<Command> commands;
    bool passes_on = false;  // another program handles the rest of the command line
};

Argument read_argument(CLI::Option& option);
// Omits options and commands of the empty group, like --help.
Command read_command(CLI::App& app, std::vector<std::string> words);

std::string capitals(std::string text);
// "tact demo dock"
std::string typed(const Command& command);
// "tact-demo-dock"
std::string page_name(const Command& command);
// True if the page of a command would have the name of another program's page.
bool is_program(const std::string& page);

// Every program of Tact.
const std::vector<std::string>& programs();

}  // namespace tact::manual
