// The frame of tact-search and tact-refine.
//
// Exit  0  done; 1  error; 2  wrong usage; 130  cancelled by Ctrl-C, nothing written
#pragma once

#include <sys/types.h>

#include <CLI/CLI.hpp>
#include <string>

namespace tact {

int run_fit_program(const char* name, const std::string& about, void (*set_up)(CLI::App&), int argc,
                    char** argv);

// For a program that starts this one and goes on working.
struct ServedProgram {
    pid_t ends_with = 0;  // 0: nobody
    bool background = false;

    void add_to(CLI::App& command);
    // Throws Cancelled if the other program has ended already.
    void apply() const;
};

}  // namespace tact
