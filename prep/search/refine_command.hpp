// tact-prep refine MAP MODEL...: moves structures to the nearest optimum of their fit, without a scene.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_refine(CLI::App& app);

}  // namespace tact
