// tact-prep drill CT and tact-prep demo drill: bake drilling scenes.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_drill(CLI::App& app, CLI::App& demo);
// tact-prep examine drill
void add_examine_drill(CLI::App& examine);

}  // namespace tact
