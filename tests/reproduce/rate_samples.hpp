// What an experiment saw of a run: force rate, picture, who used the core, and what that amounts to.
//
// Rates      cycles over time, never a mean of rates
// Windows    every stretch of a tenth of a second that ends at a sample; where it begins between two samples,
//            what they counted is divided between them
// Disturbed  a window in which programs that do not belong to the experiment had more than kForeignShareMax
//            of the core: what is left when the processor time of all parties is taken off the time that went
//            by, for the core is never idle. Or one in which an update cost kSlowerMax times as much
//            processor time as it does while the core is fast: the core itself was slower (its sibling busy,
//            or the host elsewhere). What is fast, all runs together have to say (fast_update_s()): a run
//            that met a slow core for half of its time has no measure of its own.
// Updates    cost what one that does all of its work would have: where older sums stood for a part of it
//            (given_up) the cost is scaled up, but for kFixedPart
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tact::launch {

constexpr std::size_t kParties = 4;

struct RateSample {
    double t_s = 0.0;         // since the run's first sample
    std::uint64_t cycle = 0;  // of the force loop, by then
    double level_mesh = 0.0, level_force = 0.0;
    std::uint32_t vertices = 0;
    double fps = 0.0;
    bool load = false;             // the external one runs
    double used_s[kParties] = {};  // processor time so far: controller, visual process, load, tick_source
    double given_up = 0.0;         // updates so far, each by the part of its work that older sums stood for
};

constexpr double kWindow_s = 0.1;
constexpr double kForeignShareMax = 0.03, kSlowerMax = 1.05;
constexpr double kLowestOfGoal = 0.95;
// Of an update's processor time, what does not depend on the points that it sums anew; an estimate.
constexpr double kFixedPart = 0.04;

struct RateWindow100 {
    double t_s = 0.0;  // of its end
    double rate_hz = 0.0;
    double foreign_share = 0.0;
    double update_s = 0.0;  // processor time of the controller per update that does all of its work
    double recomputed_fraction = 1.0;  // of the updates' work, what they did anew
    bool disturbed = false;
};
// One for each sample that has a whole window behind it. fast_s: of an update, see above; 0: these windows'
// own.
[[nodiscard]] std::vector<RateWindow100> windows(const std::vector<RateSample>& samples, double from_s,
                                                 double to_s, double window_s = kWindow_s,
                                                 double fast_s = 0.0);
// What an update costs on a fast core: the lower quartile. 0 of no windows.
[[nodiscard]] double fast_update_s(const std::vector<RateWindow100>& windows);

struct RateSummary {
    double seconds = 0.0;
    double rate_mean_hz = 0.0;              // cycles over time
    double rate_worst_1s_hz = 0.0;          // lowest mean over any second
    double rate_worst_100ms_hz = 0.0;       // lowest of all windows
    double rate_worst_quiet_hz = 0.0;       // lowest of the windows that nobody disturbed; 0: there were none
    double share_below_percent = 0.0;       // of the quiet windows, below 95 % of the goal; 0 without a goal
    double foreign_share = 0.0;             // of the core, over all of it
    double disturbed_percent = 0.0;         // of the windows
    double used_share[kParties] = {};       // of the core: controller, visual process, load, tick_source
    double recomputed_fraction_mean = 1.0;  // of the updates' work, what they did anew
    double recomputed_fraction_least = 1.0;  // of all windows
    double vertices_mean = 0.0, fps_mean = 0.0;
    double level_force_min = 0.0;
};

// Of the samples with t_s in [from_s, to_s]. All zero where there are fewer than two.
[[nodiscard]] RateSummary summarize(const std::vector<RateSample>& samples, double from_s, double to_s,
                                    double goal_hz = 0.0, double fast_s = 0.0);

// Time from `from_s` on until the rate over a window is back at 95 % of the goal and stays there for a
// second. Negative: never.
[[nodiscard]] double settling_s(const std::vector<RateSample>& samples, double from_s, double to_s,
                                double goal_hz);

}  // namespace tact::launch
