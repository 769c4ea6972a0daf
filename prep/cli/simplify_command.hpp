// tact-prep simplify: reads a triangle mesh and writes a simplified mesh as PLY.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tact {

// Returns the function to call if the subcommand was given.
std::function<void()> add_simplify(CLI::App& app, CLI::App*& command);

}  // namespace tact
