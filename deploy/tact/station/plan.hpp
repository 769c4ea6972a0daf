// The steps of tact station setup, as a pure function of the machine and the request.
#pragma once

#include <string>
#include <vector>

#include "deploy/tact/station/journal.hpp"
#include "deploy/tact/station/machine.hpp"

namespace tact::launch {

struct WantedFile {
    std::filesystem::path path{};
    FileKind kind = FileKind::file;
    std::string bytes{};
    mode_t mode = 0644;
};

struct PlannedStep {
    std::string name{};  // name for --skip
    std::string purpose{};
    std::vector<WantedFile> files{};
    std::vector<Command> commands{};            // run after the files are written
    std::vector<Command> undo_first{}, undo{};  // before and after the files are restored
};

struct StationRequest {
    int core = -1;
    std::string user{};               // gets the rights; empty: no user
    std::vector<std::string> skip{};  // names of steps
    std::vector<std::string>
        kernel_packages;  // packages that an installation would add; empty: only the meta package
};

struct StationPlan {
    ServoCores cores;
    std::string kernel_arguments{};
    std::vector<PlannedStep> steps{};
    std::vector<std::string> remarks{};
};

inline constexpr const char* kStepNames[] = {"kernel", "groups",  "rights",
                                             "tuning", "service", "kernel-arguments"};
inline constexpr const char* kKernelPackage = "linux-image-rt-amd64";

[[nodiscard]] std::string kernel_arguments_for(const ServoCores& cores);
// Throws StartupError if the machine cannot be set up this way.
[[nodiscard]] StationPlan make_station_plan(const StationMachine& machine, const StationRequest& request);

}  // namespace tact::launch
