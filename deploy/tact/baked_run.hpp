// What `tact dock`, `touch` and `drill` have in common: files are baked into a scene once, and that is run.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "deploy/tact/run_options.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {

struct BakedRun {
    RunOptions run;
    std::vector<std::string> prep;  // options as they were typed
    bool bake_only = false;
};

// `baked` must outlive the parsing, and callbacks hold it by address.
void add_baked_run_options(CLI::App& app, std::span<const PassedOption> prep, BakedRun& baked);

// The exit code.
int bake_and_run(const BakeRequest& request, const BakedRun& baked);

}  // namespace tact::launch
