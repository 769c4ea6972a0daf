// tact-prep export SCENE --poses FILE -o FOLDER: placed structures as files. Runs as the callback of its
// subcommand, inside of parse().
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_export(CLI::App& app);

}  // namespace tact
