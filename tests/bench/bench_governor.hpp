// Checks that the governor meets its goals: for `tact bench governor`.
//
// Runs      the whole controller as a user starts it (tact run --no-gui), once per row, over its whole time: adaptive, and a
//           sweep of fixed levels for comparison. It bakes the scenes first, in a temporary folder.
// Scenes    docking: structures of about 30 000, 160 000 and 500 000 atoms, shifted copies of one structure (from the demo or a
//           file); surface: a 6-DoF tool of 1000 points on two million triangles; drilling: a burr of 20 mm in voxels of 0.1 mm
// Row       one scene at one rate. A fixed level fits if fewer than kMissShareMost of its steps miss the deadline
// Faults    timing faults latch, as on a real arm; late wake-ups of the host do not count, because no level changes them
// Takes     about half an hour. Progress on standard error. Throws StartupError.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact {

struct GovernorBenchSettings {
    static constexpr double kMissShareMost = 1e-3;
    static constexpr double kErrorRatioMost = 1.2, kStepRatioMost = 2.0, kSettledMost_s = 0.1;

    std::vector<std::string> scenes{"docking", "surface", "drilling"};
    std::vector<std::size_t> atoms{30'000, 160'000, 500'000};
    std::vector<double> rates_hz{1000.0, 2000.0, 4000.0, 0.0};  // 0: free running
    std::filesystem::path map, structure;                       // empty: from the demo
    double seconds = 6.0, sweep_seconds = 3.0;
};

// Metrics of one run, from its report.
struct GovernorRun {
    bool fault = false;
    double miss_share = 1.0, error_n = 0.0, step_n = 0.0, level = 0.0, settled_s = 0.0, rate_hz = 0.0;
};

// Compares an adaptive run with the runs at fixed levels. Pure arithmetic.
[[nodiscard]] nlohmann::json governor_row(const GovernorRun& adaptive, const std::vector<GovernorRun>& fixed);

// "governor": one row per scene and rate; "governor_passed": true if all rows passed.
[[nodiscard]] nlohmann::json bench_governor(const GovernorBenchSettings& settings);

}  // namespace tact
