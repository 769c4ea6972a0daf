// tact station setup and undo: the steps of a plan as one transaction.
//
// Crash   the journal names a step before the step begins, so undo knows what to take back wherever setup ended.
// Error   a step that fails takes back what was done; only where that fails as well, the journal stays.
// Undo    in reverse order, the files byte for byte with mode and owner. It refuses before it changes anything where
//         somebody changed one of the files since.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "deploy/tact/station/plan.hpp"

namespace tact::launch {

struct StationTools {
    std::filesystem::path root = "/";
    // Runs a command; returns its exit code. Where commands are only recorded, it returns 0.
    std::function<int(const Command&)> run{};
    std::function<void(const std::string&)> report{};  // a line for a person
    void (*interrupt)() = [] {};                       // called between any two changes, for tests
};

enum class SetupResult { done, already_so };

// Throws StartupError.
SetupResult set_up_station(const StationPlan& plan, const StationTools& tools);
// False: there is nothing to undo. Throws StartupError. force: also what was changed since.
bool undo_station(const StationTools& tools, bool force);

// What a step changes of the files below the root; without those that are as wanted already.
[[nodiscard]] std::vector<FileChange> changes_of(const PlannedStep& step, const std::filesystem::path& root);
[[nodiscard]] std::string command_text(const Command& command);

}  // namespace tact::launch
