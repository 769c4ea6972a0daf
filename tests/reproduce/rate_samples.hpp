// Samples of a run and their evaluation: force rate, frame rate, processor time.
//
// Rates      number of cycles divided by the time, not a mean of rates
// Windows    every interval of a tenth of a second that ends at a sample; if it begins between two samples, their
//            counts are interpolated
// Disturbed  a window in which programs outside the experiment used more than kForeignShareMax of the core (elapsed
//            time minus the processor time of all parties, because the core is never idle), or in which an update took
//            more than kSlowerMax times its processor time on a fast core. In the second case the core was slower: its
//            sibling was busy, or the host ran other work. The fast time comes from all runs together
//            (fast_update_s()), because a run on a slow core alone provides no reference.
// Updates    cost of an update with all of its work: if older sums replaced a part of the work (given_up), the cost is
//            scaled up, except for kFixedPart
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tact::launch {

constexpr std::size_t kParties = 4;

struct RateSample {
    double t_s = 0.0;         // since the first sample of the run
    std::uint64_t cycle = 0;  // number of cycles of the force loop so far
    double level_mesh = 0.0, level_force = 0.0;
    std::uint32_t vertices = 0;
    double structures = 1.0, pixels = 1.0;  // drawn fractions of full detail
    double fps = 0.0;
    bool load = false;             // the external load runs
    double used_s[kParties] = {};  // processor time so far: controller, visual process, load, tick_source
    double given_up = 0.0;         // sum over updates of the work fraction replaced by older sums
};

constexpr double kWindow_s = 0.1;
constexpr double kForeignShareMax = 0.03, kSlowerMax = 1.05;
constexpr double kLowestOfGoal = 0.95;
constexpr double kLevelChange = 0.01;  // relative
// Estimated fraction of the processor time of an update that does not depend on the number of recomputed points.
constexpr double kFixedPart = 0.04;

struct RateWindow100 {
    double t_s = 0.0;  // end of the window
    double rate_hz = 0.0;
    double foreign_share = 0.0;
    double update_s = 0.0;  // processor time of the controller per update, scaled to all of its work
    double recomputed_fraction = 1.0;  // recomputed fraction of the work of the updates
    bool disturbed = false;
};
// Returns one window per sample that ends a complete window. fast_s: time of an update on a fast core; 0: determined
// from these windows.
[[nodiscard]] std::vector<RateWindow100> windows(const std::vector<RateSample>& samples, double from_s,
                                                 double to_s, double window_s = kWindow_s,
                                                 double fast_s = 0.0);
// Processor time of an update on a fast core: the lower quartile; 0 without windows.
[[nodiscard]] double fast_update_s(const std::vector<RateWindow100>& windows);

struct RateSummary {
    double seconds = 0.0;
    double rate_mean_hz = 0.0;         // number of cycles / time
    double rate_worst_1s_hz = 0.0;     // lowest mean over any second
    double rate_worst_100ms_hz = 0.0;  // lowest of all windows
    double rate_worst_quiet_hz = 0.0;  // lowest of the undisturbed windows; 0: no such window
    double share_below_percent = 0.0;  // undisturbed windows below 95 % of the goal; 0 without a goal
    double foreign_share = 0.0;        // fraction of the core used by other programs, over the whole time
    double disturbed_percent = 0.0;    // percentage of disturbed windows
    double used_share[kParties] = {};  // fractions of the core: controller, visual process, load, tick_source
    double recomputed_fraction_mean = 1.0;   // recomputed fraction of the work
    double recomputed_fraction_least = 1.0;  // lowest of all windows
    double vertices_mean = 0.0, vertices_sd = 0.0, fps_mean = 0.0;
    double structures_mean = 0.0, pixels_mean = 0.0;
    int level_changes = 0;  // of the mesh, by more than kLevelChange since the last one
    double level_force_min = 0.0;
};

// Summarizes the samples with t_s in [from_s, to_s]. All zero with fewer than two samples.
[[nodiscard]] RateSummary summarize(const std::vector<RateSample>& samples, double from_s, double to_s,
                                    double goal_hz = 0.0, double fast_s = 0.0);

// Time from `from_s` until the rate over a window reaches 95 % of the goal and stays above it for a second. Negative:
// never settled.
[[nodiscard]] double settling_s(const std::vector<RateSample>& samples, double from_s, double to_s,
                                double goal_hz);

}  // namespace tact::launch
