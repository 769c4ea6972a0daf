// tact-prep simplify: any triangle mesh in, any level of it out as PLY.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tact {

// What to call when the subcommand was given.
std::function<void()> add_simplify(CLI::App& app, CLI::App*& command);

}  // namespace tact
