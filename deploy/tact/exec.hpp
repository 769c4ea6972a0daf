// Replaces this process by a program beside tact, so that signals, exit code and --help are those of the program.
#pragma once

#include <unistd.h>

#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

// Throws StartupError if the program cannot be started.
[[noreturn]] inline void exec_program(const std::string& name, std::vector<std::string> words) {
    const std::filesystem::path program = find_program(name);
    words.insert(words.begin(), name);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    throw StartupError("starting " + program.string(), last_error(), "build the program again");
}

}  // namespace tact::launch
