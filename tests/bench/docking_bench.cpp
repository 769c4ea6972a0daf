// Time of the inner loop of docking: sums of a density map over points, by kernel, number of points and voxel size.
//
// Cases      each kernel that this processor supports, with 200 points in random order (a codebook) and 100 000 points
//            along a Morton curve (atoms), as the force model stores them
// Arguments  number of points; voxel size in picometres
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/random.hpp"
#include "ipc/scene/density/density_kernels.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {
namespace {

// A ball of protein; with 100 000 atoms, one heavy atom per 18 cubic angstrom.
constexpr double kBallM = 75e-10;

PointSet ball(std::size_t count) {
    SeededRandom random(1);
    std::vector<float> x, y, z, w(count, 1.0F / static_cast<float>(count));
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p = kBallM * std::cbrt(random.uniform()) * random.direction();
        x.push_back(static_cast<float>(p.x()));
        y.push_back(static_cast<float>(p.y()));
        z.push_back(static_cast<float>(p.z()));
    }
    return make_point_set({x, y, z, w}, "ball");
}

const DensityGrid& grid(std::int64_t voxel_pm) {
    static std::map<std::int64_t, DensityGrid> made;
    DensityGrid& g = made[voxel_pm];
    if (g.values.empty()) {
        const auto side = static_cast<std::uint32_t>(200e-10 / (1e-12 * static_cast<double>(voxel_pm)));
        g.size = {side, side, side};
        g.spacing_m = Vec3::Constant(1e-12 * static_cast<double>(voxel_pm));
        SeededRandom random(2);
        g.values.resize(g.count());
        for (float& v : g.values) v = static_cast<float>(random.uniform());
    }
    return g;
}

void sum(benchmark::State& state, const DensityKernel* kernel) {
    DensityMap::Options options;
    options.kernel = kernel;
    const DensityMap map(grid(state.range(1)), 0.5, 1.0, options);
    const PointSet points = ball(static_cast<std::size_t>(state.range(0)));
    const Vec3 middle = Vec3::Constant(100e-10);
    int i = 0;
    for (auto _ : state) {
        ++i;  // the body moves slightly, as in a hand
        const Pose pose{middle + 5e-10 * Vec3(std::sin(1e-3 * i), std::cos(2e-3 * i), std::sin(3e-3 * i)),
                        quat_from_rotation_vector(0.1 * Vec3(std::cos(1e-3 * i), std::sin(1e-3 * i), 0.5))};
        benchmark::DoNotOptimize(map.sum(points.view(), pose));
    }
    state.counters["ns_per_point"] =
        benchmark::Counter(static_cast<double>(state.range(0)) * 1e-9,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["map_MB"] = static_cast<double>(map.bytes()) * 1e-6;
}

const bool kRegistered = [] {
    for (std::size_t k = 0; k < kDensityKernelCount; ++k) {
        const DensityKernel* kernel = &kDensityKernels[k];
        if (!kernel->runs_here()) continue;
        benchmark::RegisterBenchmark((std::string("density_sum/") + kernel->name).c_str(),
                                     [kernel](benchmark::State& state) { sum(state, kernel); })
            ->ArgsProduct({{200, 100000}, {100, 200, 400}})
            ->Unit(benchmark::kMicrosecond);
    }
    return true;
}();

}  // namespace
}  // namespace tact
