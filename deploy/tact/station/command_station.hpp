// Adds tact station to the parser.
#pragma once

#include <CLI/CLI.hpp>

namespace tact::launch {

void add_station(CLI::App& app, int& exit_code);

}  // namespace tact::launch
