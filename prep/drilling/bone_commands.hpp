// tact-prep export-bone and tact-prep compare-bone: drilled bone for other programs, and against an expert's.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_bone_commands(CLI::App& app);

}  // namespace tact
