// The docking seed's load balancing (its figures 5, 7 and 8), run again on this machine.
//
// Set-up   controller and visual process on one core with ordinary scheduling, the force loop running freely,
//          the picture drawn in software; an external number-crunching load on the same core, switched on
//          part-way.
// Scale    today's core is some hundred times faster, so every atom is felt many times and the surface is
//          finer (experiment_scene.hpp), such that the goal under load is about a thousand updates a second.
// Goals    without load 1.45 times the unadapted rate, as the seed's 800 is of its 550, and 2.2 times, as its
//          1200; with load 0.92 of what the coarsest picture would reach, measured before.
// Thread   one; blocks for about a minute and a half, a tenth of that with quick.
// Fails by StartupError; leaves no process behind.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct GovernorExperiment {
    std::filesystem::path out;  // folder
    int core = -1;              // -1: the last that this process may use
    double fps_max = 20.0;
    double goal_hz = 0.0;  // under load; 0: from the measurement
    bool quick = false;    // shorter, unscaled again: shows that everything works, not what it is worth
};

// Writes governor.csv, governor.png, governor_free.png and governor.json. Returns the exit code.
int reproduce_governor(const GovernorExperiment& experiment);

// What is drawn and summed up.

struct RateSample {
    double t_s = 0.0;         // since the run's first sample
    std::uint64_t cycle = 0;  // of the force loop, at the published instant
    std::int64_t taken_at_ns = 0;
    double rate_hz = 0.0;  // since the sample before
    double level_mesh = 0.0, level_force = 0.0;
    std::uint32_t vertices = 0;
    double fps = 0.0;
    bool load = false;
};

struct RateSummary {
    double seconds = 0.0;
    double rate_mean_hz = 0.0;      // cycles over time
    double rate_worst_1s_hz = 0.0;  // lowest mean over any second
    double vertices_mean = 0.0, fps_mean = 0.0;
    double level_force_min = 0.0;
};

// Of the samples with t_s in [from_s, to_s]. All zero where there are fewer than two.
[[nodiscard]] RateSummary summarize(const std::vector<RateSample>& samples, double from_s, double to_s);

}  // namespace tact::launch
