// Two hidden requests that every program answers from its own command line parser, so that man pages and
// completion never differ from --help:
//   --manual DIR   writes the man pages of the program and of its commands to DIR
//   --completion   prints the data that deploy/manual/completion.bash completes with
//
// It also makes --help print values, ranges and defaults as the man pages do (help.hpp).
//
// Runs on   start-up, before the command line is parsed; costs two string comparisons otherwise
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tact::manual {

// A line of the section FILES.
struct File {
    std::string path, about;
};

// The exit code, if one of the requests was on the command line: the program then ends with it.
std::optional<int> answer(CLI::App& app, const std::string& program, int argc, const char* const* argv,
                          const std::vector<File>& files = {});

}  // namespace tact::manual
