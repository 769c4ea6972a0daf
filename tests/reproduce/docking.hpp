// tact reproduce docking: figures 3 to 8 of the docking paper, compared with the published values.
//
// Writes   CSV and PNG of every figure, docking.json with all numbers, conditions and the summary table
// Prints   the summary table, with differences and their reasons
// Thread   one; blocks for about a minute and a half. Fails by StartupError. Ends all child processes.
#pragma once

#include <filesystem>

#include "tests/reproduce/rates.hpp"

namespace tact::launch {

struct DockingExperiment {
    std::filesystem::path out;  // folder
    RatesSettings rates{};
    bool with_meshes = true;  // figures 3, 4 and 6; false: only the rates
};

int reproduce_docking(const DockingExperiment& experiment);  // returns the exit code

}  // namespace tact::launch
