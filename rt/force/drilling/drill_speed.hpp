// Time of a drilling step's work on this machine.
//
// Time     constants of one core (README.md), times a factor of this machine for each kind of work: processors differ by
//          more in the one than in the other
// Fit      to steps that were timed. What the steps tell apart only badly is drawn to the factor that all have in common,
//          and no factor is more than kApart times off it. Robust: steps that other programs held do not count much
// Thread   any; drill_cost() in constant time, no allocation; the rest allocates
#pragma once

#include <span>
#include <vector>

#include "rt/force/drilling/drill_load.hpp"

namespace tact {

// Times over the constants.
struct DrillSpeed {
    double walk = 1.0;    // balls and blocks
    double parts = 1.0;   // eighths of bricks
    double voxels = 1.0;  // bricks, voxel by voxel
    double cut = 1.0;     // erosion
    static constexpr double kApart = 4.0;
};
[[nodiscard]] Duration drill_cost(const DrillWork& work, const DrillSpeed& speed = {}) noexcept TACT_RT;

struct TimedWork {
    DrillWork work;
    double measured_ns;
};
[[nodiscard]] DrillSpeed fit_speed(std::span<const TimedWork> steps);
// Of a trial, those that occur in a loop: no longer than its period. Where the machine is too slow for enough of them, all.
[[nodiscard]] std::vector<TimedWork> telling_steps(const std::vector<TimedWork>& steps, double step_s);

}  // namespace tact
