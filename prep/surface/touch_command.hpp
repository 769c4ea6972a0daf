// tact-prep touch MESH and tact-prep demo touch: bake scenes with a surface to touch.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_touch(CLI::App& app, CLI::App& demo);

}  // namespace tact
