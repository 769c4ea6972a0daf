// Measures the cost of moving particles, and how well a step keeps its time budget, for `tact bench drilling`.
//
// Work     dust, water and blood about a hole in 256 x 128 x 128 voxels of 0.3 mm; a hundredth of them is new with every
//          step of 10 ms; 1000, 10 000, 100 000 and 200 000 of them, in 20 us, 200 us, 2 and 4 ms a step: some quarter
//          of them is moved in each
// Keys     particle_ns_each_N: of one move, from the steps' time over their moves; particle_moves_N: a step
//          particle_budget_error_N, _p99_N: | time of a step / its budget - 1 |, mean and 99th of a hundred, of steps
//          that had more to do than their budget; absent where none had
//          particle_step_us_p50_N, _p99_N, _p999_N, _max_N: of a step
//          those without a number: of the 100 000
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
