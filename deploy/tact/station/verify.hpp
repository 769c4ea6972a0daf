// tact station verify: runs the controller as shipped on an emulated device and measures the lateness on this machine.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "deploy/tact/station/judge.hpp"

namespace tact::launch {

struct VerifyOptions {
    double seconds = 60.0;
    std::filesystem::path scene;     // empty: a synthetic scene
    std::filesystem::path config;    // of tact-rt; empty: its defaults
    std::filesystem::path programs;  // folder of tact-rt; empty: that of tact
    int core = -1;                   // core of the servo; -1: chosen by the controller
};

// Empty if a signal ended it. Throws StartupError. `report` gets a progress line at intervals.
[[nodiscard]] std::optional<VerifyMetrics> measure_station(
    const VerifyOptions& options, const std::function<void(const std::string&)>& report);

}  // namespace tact::launch
