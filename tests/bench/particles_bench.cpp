// Particles near a hole in bone: cost of one particle move, and time of a step relative to its budget.
//
// Metrics   particle_ns_each: time per moved particle; moved: particles moved per step; over_p50, over_p99: time of a
//           step divided by its budget, over the steps that could not move all particles; alive: number of particles
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gui/drilling/particles.hpp"

namespace {

using namespace tact;

void step_of_a_budget(benchmark::State& state) {
    const auto most = static_cast<std::uint32_t>(state.range(0));
    const double budget_s = 1e-6 * static_cast<double>(state.range(1));
    const BoneBricks bricks{.size = {256, 128, 128}, .voxel_m = 3e-4};
    std::vector<std::uint8_t> density(bricks.bytes(), 0);
    for (std::uint32_t z = 0; z < 128; ++z)
        for (std::uint32_t y = 0; y < 40; ++y)
            for (std::uint32_t x = 0; x < 256; ++x) density[bricks.voxel(x, y, z)] = 200;
    Particles particles(bricks, density, {.most = most});
    SeededRandom random(1);
    // Most particles are at rest; each step adds a hundredth of the maximum.
    const auto fill = [&](std::size_t count) {
        for (std::size_t misses = 0; count > 0 && misses < 1000 && particles.all().size() < most;) {
            const double far = 90.0 * random.uniform(), angle = 6.28 * random.uniform();
            const Vec3 at(128.0 + far * std::cos(angle), 42.0 + 6.0 * random.uniform(),
                          64.0 + 0.6 * far * std::sin(angle));
            const auto matter = static_cast<Matter>(random.below(3));
            const bool made = particles.emit(matter, bricks.to_model(at), random.within(0.3));
            made ? --count : ++misses;
        }
    };
    for (int i = 0; i < 400 && particles.all().size() < most; ++i) {
        fill(most / 100);
        static_cast<void>(particles.step(0.01, 10.0, Vec3::Zero(), {}));
    }
    std::vector<double> over;
    double moved = 0.0, seconds = 0.0;
    for (auto _ : state) {
        state.PauseTiming();
        fill(most / 100);
        state.ResumeTiming();
        const ParticleStep step = particles.step(0.01, budget_s, bricks.to_model(Vec3(128, 64, 64)), {});
        moved += step.moved;
        seconds += step.cost_s;
        if (step.moved < step.alive) over.push_back(step.cost_s / budget_s);
    }
    std::sort(over.begin(), over.end());
    state.counters["particle_ns_each"] = 1e9 * seconds / std::max(moved, 1.0);
    state.counters["moved"] = moved / static_cast<double>(state.iterations());
    if (!over.empty()) {
        state.counters["over_p50"] = over[over.size() / 2];
        state.counters["over_p99"] = over[over.size() * 99 / 100];
    }
    state.counters["alive"] = static_cast<double>(particles.all().size());
}

}  // namespace

BENCHMARK(step_of_a_budget)
    ->ArgsProduct({{1000, 10000, 50000, 200000}, {50, 500, 2000}})
    ->Unit(benchmark::kMicrosecond);
