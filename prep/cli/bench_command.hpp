// tact-prep bench: how fast and how well this machine simplifies meshes made in code. Part of `tact bench
// docking`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tact {

// What to call when the subcommand was given. Takes about two seconds.
std::function<void()> add_bench(CLI::App& app, CLI::App*& command);

}  // namespace tact
