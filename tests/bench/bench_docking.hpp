// Cost of the docking force on this machine: for `tact bench docking`.
//
// Method   the servo's force model with a synthetic map of 128^3 voxels of 2 A and 100 000 atoms at the density of
//          protein; the body moves slightly in each step, as in a hand. The times are those of whole steps in one pass
//          at 1 kHz, in a thread configured like the servo thread (loop_thread.hpp).
// Best     best_of_20: the smallest median of twenty series of forces without pauses. It estimates the cost of the code
//          on a machine whose other users slow the core for most of the time.
// Takes    about nine seconds, one of them to make the synthetic codebook and the map
#pragma once

#include <cstdint>
#include <string>

#include "tests/bench/percentiles.hpp"

namespace tact {

struct DockingBench {
    std::string kernel;                                                          // instruction set in use
    Percentiles force_us_n200;                                                   // with 200 codebook vectors
    Percentiles force_us_atoms100k;                                              // with all atoms
    double force_us_n200_best_of_20 = 0.0, force_us_atoms100k_best_of_20 = 0.0;  // see Best above
    double ns_per_point_n200 = 0.0, ns_per_point_atoms = 0.0;
    std::uint64_t map_bytes = 0;  // size of the coefficients in memory
};

struct DockingBenchSettings {
    int steps = 4000;                                 // number of steps of the loop
    int stretch_n200 = 1000, stretch_atoms100k = 20;  // forces per series
};

[[nodiscard]] DockingBench bench_docking(const DockingBenchSettings& settings = {});

}  // namespace tact
