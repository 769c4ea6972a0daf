// tact-refine MAP MODEL...: moves structures to the nearest optimum of their fit, without a scene.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

// Adds the options to the program's parser, and what it does when they are parsed.
void set_up_refine(CLI::App& app);

}  // namespace tact
