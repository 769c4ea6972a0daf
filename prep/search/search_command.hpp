// tact-prep search MAP MODEL...: finds the places of structures in a map, without a scene.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_search(CLI::App& app);

}  // namespace tact
