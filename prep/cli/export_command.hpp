// tact-prep export SCENE --poses FILE -o FOLDER: writes placed structures to files. Runs as the callback of its
// subcommand, inside parse().
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_export(CLI::App& app);

}  // namespace tact
