// Two hidden options that every program answers from its own command line parser, so that man pages and
// completion always agree with --help:
//   --manual DIR   writes the man pages of the program and of its commands to DIR
//   --completion   prints the data for deploy/manual/completion.bash
//
// Also makes --help print values, ranges and defaults like the man pages (help.hpp).
//
// Call      at start-up, before the command line is parsed; costs two string comparisons otherwise
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tact::manual {

// An entry of the section FILES.
struct File {
    std::string path, about;
};

// The exit code, if one of these options was given: the program must then exit with it.
std::optional<int> answer(CLI::App& app, const std::string& program, int argc, const char* const* argv,
                          const std::vector<File>& files = {});

}  // namespace tact::manual
