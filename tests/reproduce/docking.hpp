// tact reproduce docking: the docking paper's figures 3 to 8 on this machine, its values beside ours.
//
// Writes   CSV and PNG of every figure, docking.json with all numbers, conditions and the summary table
// Says     the table: what differs and why
// Thread   one; blocks for about a minute and a half. Fails by StartupError; leaves no process behind.
#pragma once

#include <filesystem>

#include "tests/reproduce/rates.hpp"

namespace tact::launch {

struct DockingExperiment {
    std::filesystem::path out;  // folder
    RatesSettings rates{};
    bool with_meshes = true;  // figures 3, 4 and 6; else the rates alone
};

int reproduce_docking(const DockingExperiment& experiment);  // the exit code

}  // namespace tact::launch
