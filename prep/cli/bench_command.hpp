// tact-prep bench: speed and quality of mesh simplification on synthetic meshes. Part of `tact bench docking`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tact {

// Returns the function to call if the subcommand was given. It takes about two seconds.
std::function<void()> add_bench(CLI::App& app, CLI::App*& command);

}  // namespace tact
