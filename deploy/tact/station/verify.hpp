// tact station verify: the controller as shipped, on an emulated device, and what this machine does to it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "deploy/tact/station/judge.hpp"

namespace tact::launch {

struct VerifyOptions {
    double seconds = 60.0;
    std::filesystem::path scene;     // empty: a synthetic one
    std::filesystem::path config;    // of tact-rt; empty: its defaults
    std::filesystem::path programs;  // folder of tact-rt; empty: beside tact
    int core = -1;                   // of the servo; -1: as the controller chooses
};

// Nothing: a signal ended it. Throws StartupError. `report` gets a line for a person now and then.
[[nodiscard]] std::optional<VerifyMetrics> measure_station(
    const VerifyOptions& options, const std::function<void(const std::string&)>& report);

}  // namespace tact::launch
