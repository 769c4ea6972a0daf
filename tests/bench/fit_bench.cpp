// Time to evaluate the fit of bodies in a map and to refine a pose. Map: 100^3 voxels of 2.7 Å at a resolution of
// 11.5 Å, like a map of a chaperonin; bodies with the number of atoms of its seven-membered ring.
#include <benchmark/benchmark.h>

#include "ipc/base/random.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/scene/fit/refine.hpp"

namespace tact {
namespace {

constexpr double kA = kAngstromM;

Structure ring(std::size_t atoms) {
    Structure s;
    SeededRandom random(1);
    Vec3 mean = Vec3::Zero();
    std::vector<Vec3> at;
    while (at.size() < atoms) {
        const Vec3 p =
            Vec3(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, random.uniform() - 0.5);
        const double r = p.head<2>().norm();
        if (r > 1.0 || r < 0.35) continue;
        at.emplace_back(68.0 * kA * p);
        mean += at.back() / static_cast<double>(atoms);
    }
    for (const Vec3& p : at) {
        s.x_m.push_back(static_cast<float>(p.x() - mean.x()));
        s.y_m.push_back(static_cast<float>(p.y() - mean.y()));
        s.z_m.push_back(static_cast<float>(p.z() - mean.z()));
        s.mass_fraction.push_back(1.0F / static_cast<float>(atoms));
        s.element.push_back(6);
    }
    s.mass_u = 12.0 * static_cast<double>(atoms);
    return s;
}

DensityGrid map_of(const Structure& s, double resolution_m) {
    DensityGrid grid;
    grid.size = {100, 100, 100};
    grid.spacing_m = Vec3::Constant(2.7 * kA);
    grid.origin_m = Vec3::Constant(-133.65 * kA);
    const PlacedStructure placed{&s, Pose{}};
    grid.values = simulated_map(grid, {&placed, 1}, resolution_m);
    return grid;
}

void fit(benchmark::State& state) {
    const auto bodies = static_cast<std::size_t>(state.range(0));
    const Structure s = ring(27'000 / bodies);
    const DensityGrid grid = map_of(s, 11.5 * kA);
    const std::vector<PlacedStructure> placed(bodies, PlacedStructure{&s, Pose{}});
    for (auto _ : state) benchmark::DoNotOptimize(fit_of_bodies(grid, placed, {.resolution_m = 11.5 * kA}));
}
BENCHMARK(fit)->Arg(1)->Arg(7)->Unit(benchmark::kMillisecond);

void refinement(benchmark::State& state) {
    const Structure s = ring(27'000);
    const DensityGrid grid = map_of(s, 11.5 * kA);
    const DensityMap map(grid, 0.0, 100.0);
    RefineSettings settings;
    settings.goal = static_cast<RefineGoal>(state.range(0));
    settings.resolution_m = 11.5 * kA;
    const Pose start{Vec3(1.2, 1.2, 1.0) * kA, quat_from_rotation_vector(Vec3(0.1, 0.1, 0.1))};
    std::uint32_t iterations = 0;
    for (auto _ : state) iterations = refine(map, s, start, settings).iterations;
    state.counters["iterations"] = iterations;
}
BENCHMARK(refinement)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
