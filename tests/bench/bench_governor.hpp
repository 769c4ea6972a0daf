// Checks that the governor meets its goals: for `tact bench governor`.
//
// Runs      tact run --no-gui, as a user starts it: for each row one run per fixed level, and an adaptive run before,
//           between and after those that are valid; the median of the adaptive runs counts, and a fault in any of them.
//           On scenes of bench_governor_scenes.hpp.
// Row       one scene at one rate. A fixed level is valid if the fraction of its steps that miss the deadline is below
//           kMissShareMost. Levels are tried from the top, over the same path of the hand, until kValidLevels are
//           valid: lower ones have larger errors.
// Faults    timing faults latch, as on a real arm. Late wake-ups of the host are not faults: they do not depend on the
//           level.
// Quiet     core_speed_spread of a row is that of core_speed.hpp, sampled before each of its runs. On a core that is not quiet
//           (core_quiet) levels must move, and runs one after the other meet different machines: such a row says little.
// Takes     about forty minutes; prints progress to standard error. Throws StartupError.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tests/bench/bench_governor_scenes.hpp"

namespace tact {

struct GovernorBenchSettings {
    static constexpr double kMissShareMost = 1e-3;
    static constexpr int kValidLevels = 2;
    static constexpr double kErrorRatioMost = 1.2, kStepRatioMost = 2.0, kSettledMost_s = 0.1;

    GovernorSceneSettings scenes;
    std::vector<double> rates_hz{1000.0, 2000.0, 4000.0, 0.0};  // 0: free running
    double seconds = 6.0;
    bool bake_only = false;  // measures nothing
};

// Metrics of one run, read from its report.
struct GovernorRun {
    bool fault = false;
    double miss_share = 1.0, error_n = 0.0, step_n = 0.0, level = 0.0, settled_s = 0.0, rate_hz = 0.0;
};

// Of the JSON report of `tact run`. A loop that left no time to arm or to publish anything counts as a fault.
[[nodiscard]] GovernorRun governor_run_of(const nlohmann::json& report);
[[nodiscard]] bool valid_level(const GovernorRun& fixed);
// Of each metric; at least one run. A fault in any run is one.
[[nodiscard]] GovernorRun median_of(const std::vector<GovernorRun>& runs);
// Compares an adaptive run with the runs at fixed levels. Pure arithmetic.
[[nodiscard]] nlohmann::json governor_row(const GovernorRun& adaptive, const std::vector<GovernorRun>& fixed);

// bake_only: "governor_scenes", the scenes' files. Otherwise "governor": one row per scene and rate; "governor_passed": true if all rows passed; "governor_core_quiet": true if
// the core was quiet during all of them.
[[nodiscard]] nlohmann::json bench_governor(const GovernorBenchSettings& settings);

}  // namespace tact
