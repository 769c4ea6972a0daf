// tact-prep touch MESH and tact-prep demo touch: scenes of a surface to touch.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_touch(CLI::App& app, CLI::App& demo);

}  // namespace tact
