// The frame of tact-search and tact-refine.
//
// Exit  0  done; 1  error; 2  wrong usage; 130  cancelled by Ctrl-C, nothing written
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tact {

int run_fit_program(const char* name, const std::string& about, void (*set_up)(CLI::App&), int argc,
                    char** argv);

}  // namespace tact
