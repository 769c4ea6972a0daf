// Cost of the docking force on this machine: for `tact bench docking`.
//
// Method   the servo's force model over a map of 128^3 voxels of 2 A made in memory and 100 000 atoms at the
//          density of protein; the body moves a little in each step, as in a hand. Times are of whole steps,
//          on one core, with the caches as the steps leave them.
// Quietest the minimum of the medians of twenty series of steps: the cost of the code where other users of the
//          machine slow the core most of the time
// Takes    about three seconds, one of them to make a substitute for a codebook and the map.
#pragma once

#include <cstdint>
#include <string>

namespace tact {

struct DockingBench {
    std::string kernel;              // instruction set in use
    double force_us_n200_p50 = 0.0;  // 200 codebook vectors
    double force_us_n200_p99 = 0.0;
    double force_us_atoms100k_p50 = 0.0;  // all atoms
    double force_us_atoms100k_p99 = 0.0;
    double force_us_n200_quietest = 0.0, force_us_atoms100k_quietest = 0.0;  // see Quietest
    double ns_per_point_n200 = 0.0, ns_per_point_atoms = 0.0;
    std::uint64_t map_bytes = 0;  // of coefficients in memory
};

struct DockingBenchSettings {
    int steps_n200 = 20000, steps_atoms100k = 400;
};

[[nodiscard]] DockingBench bench_docking(const DockingBenchSettings& settings = {});

}  // namespace tact
