// tact-search MAP MODEL...: finds the places of structures in a map, without a scene.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

// Adds the options to the program's parser, and what it does when they are parsed.
void set_up_search(CLI::App& app);

}  // namespace tact
