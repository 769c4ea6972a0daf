// tact station setup and undo: the steps of a plan as one transaction.
//
// Crash   the journal names a step before the step begins, so undo knows the steps to revert wherever setup ended.
// Error   a failed step reverts all earlier steps; the journal stays only if that fails as well.
// Undo    in reverse order; restores files byte for byte with mode and owner. It refuses, before it changes anything,
//         if one of the files was changed since.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "deploy/tact/station/plan.hpp"

namespace tact::launch {

struct StationTools {
    std::filesystem::path root = "/";
    // Runs a command and returns its exit code; returns 0 if commands are only recorded.
    std::function<int(const Command&)> run{};
    std::function<void(const std::string&)> report{};  // prints a line for a person
    void (*interrupt)() = [] {};                       // called between any two changes, for tests
};

enum class SetupResult { done, already_so };

// Throws StartupError.
SetupResult set_up_station(const StationPlan& plan, const StationTools& tools);
// False: nothing to undo. Throws StartupError. force: also restores files that were changed since.
bool undo_station(const StationTools& tools, bool force);

// The file changes of a step below the root, without files that are already as wanted.
[[nodiscard]] std::vector<FileChange> changes_of(const PlannedStep& step, const std::filesystem::path& root);
[[nodiscard]] std::string command_text(const Command& command);

}  // namespace tact::launch
