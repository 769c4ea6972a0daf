// Options of the tool that touches the surface, for tact touch and tact demo touch. tact-prep checks the values.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {

struct ToolOptions {
    std::string tool;  // a file or a name; empty: none
    std::vector<std::string> prep;
    void add_to(BakeRequest& request) const;
};

std::shared_ptr<ToolOptions> add_tool_options(CLI::App& app);

}  // namespace tact::launch
