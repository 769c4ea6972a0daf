// Cost of the docking force on this machine: for `tact bench docking`.
//
// Method   the servo's force model over a map of 128^3 voxels of 2 A made in memory and 100 000 atoms at the
//          density of protein; each step the body moves a little, as in a hand. Numbers are of whole steps in
//          one pass at 1 kHz, in a thread like the servo's (loop_thread.hpp).
// Best     of 20: the least median of twenty stretches of forces that follow each other at once: what the code costs where
//          other users of the machine slow the core for most of the time
// Takes    about nine seconds, one of them to make the codebook stand-in and the map.
#pragma once

#include <cstdint>
#include <string>

#include "tests/bench/percentiles.hpp"

namespace tact {

struct DockingBench {
    std::string kernel;                                                          // instruction set in use
    Percentiles force_us_n200;                                                   // 200 codebook vectors
    Percentiles force_us_atoms100k;                                              // all atoms
    double force_us_n200_best_of_20 = 0.0, force_us_atoms100k_best_of_20 = 0.0;  // see Best
    double ns_per_point_n200 = 0.0, ns_per_point_atoms = 0.0;
    std::uint64_t map_bytes = 0;  // of coefficients in memory
};

struct DockingBenchSettings {
    int steps = 4000;  // of the loop
    int stretch_n200 = 1000, stretch_atoms100k = 20;
};

[[nodiscard]] DockingBench bench_docking(const DockingBenchSettings& settings = {});

}  // namespace tact
