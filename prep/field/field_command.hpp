// tact-prep field FILE and tact-prep demo field: bake scenes of a potential field.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_field(CLI::App& app, CLI::App& demo);

}  // namespace tact
