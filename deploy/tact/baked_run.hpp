// Shared by `tact dock`, `touch`, `drill` and `field`: bake files into a scene once, then run it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "deploy/tact/run_options.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {

struct BakedRun {
    RunOptions run;
    std::vector<std::string> prep;             // options for tact-prep, as typed
    std::vector<std::filesystem::path> files;  // that they name
    bool bake_only = false;
};

// `baked` must outlive parsing: the callbacks hold its address.
void add_baked_run_options(CLI::App& app, std::span<const PassedOption> prep, BakedRun& baked);

// Options of a demo, which has no files.
void add_demo_run_options(CLI::App& app, BakedRun& baked);

// Returns the exit code.
int bake_and_run(BakeRequest request, const BakedRun& baked);

}  // namespace tact::launch
