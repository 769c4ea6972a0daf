// Measures the cost of moving particles, and how well a step keeps its time budget, for `tact bench drilling`.
//
// Work     dust, water and blood around a hole in 256 x 128 x 128 voxels of 0.3 mm; a hundredth is new in every step
//          of 10 ms; 1000, 10 000, 100 000 and 200 000 particles with 20 us, 200 us, 2 and 4 ms per step, so that
//          about a quarter of them moves in each
// Keys     particle_ns_each_N: time per move; particle_moves_N: moves per step particle_budget_error_N, _p99_N: |
//          time of a step / its budget - 1 |, mean and 99th percentile, over steps that had more work than their
//          budget; absent if there were none particle_ns_each, particle_budget_error: for 100 000 particles
// No window, no display; half a minute at most
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace tact {

struct ParticlesBenchSettings {
    std::vector<std::uint32_t> counts = {1000, 10000, 100000, 200000};
    int steps = 300;
    double budget_s = 2e-3;  // for 100 000 particles; proportional for other counts
};
nlohmann::json bench_particles(const ParticlesBenchSettings& settings = {});

}  // namespace tact
