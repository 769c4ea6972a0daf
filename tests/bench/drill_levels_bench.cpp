// Cost, reported error and force deviation of each level of the drilling knob.
//
// Stroke    60 mm/s to and fro in solid bone with a grain, down to 1 mm in 0.3 s, then with a feed of 3 mm/s; default
//           erosion rate, one pass, undrilled bone for each level. Servo rate `hz`.
// Metrics   us: time of DrillModel::step(); force_us: time of the force alone (ball_moments() at the same position);
//           items, error_n: as reported by the step; n_off: deviation (N) from the force at the full level in the same
//           step; n_step: change of the force between two steps (N); predicted: cost predicted by predict() before the
//           step, relative to the measured cost
// Measured  see rt/force/drilling/README.md
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

struct Bone {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    std::vector<std::uint32_t> revision;

    Bone(const std::array<std::uint32_t, 3>& size, double voxel_m) {
        bricks.size = size;
        bricks.voxel_m = voxel_m;
        bricks.origin_m = -voxel_m * 0.5 * Vec3(size[0] - 1.0, size[1] - 1.0, size[2] - 1.0);
        density.resize(bricks.bytes());
        revision.resize(bricks.brick_count());
        for (std::uint32_t z = 0; z < size[2] / 2; ++z)
            for (std::uint32_t y = 0; y < size[1]; ++y)
                for (std::uint32_t x = 0; x < size[0]; ++x)
                    density[bricks.voxel(x, y, z)] =
                        static_cast<std::uint8_t>(200 + (x * 7 + y * 13 + z * 29) % 56);
    }
};

double quantile(std::vector<double> values, double fraction) {
    std::sort(values.begin(), values.end());
    return values.empty()
               ? 0.0
               : values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::vector<Vec3>> full_level_n;

void level(benchmark::State& state) {
    const double radius_m = 1e-4 * static_cast<double>(state.range(0)),
                 voxel_m = 1e-4 * static_cast<double>(state.range(1)),
                 step_s = 1.0 / static_cast<double>(state.range(2));
    const auto fidelity = 0.01F * static_cast<float>(state.range(3));
    const bool large = radius_m > 1e-2 || voxel_m < 2e-4;
    const std::uint32_t edge = large ? (voxel_m < 2e-4 ? 512 : 256) : 128;
    std::vector<double> us, force_us, off_n, items, error_n, ratio, step_n;
    double removed_mm3 = 0.0;
    for (auto _ : state) {
        Bone bone({edge, edge, large ? 128U : edge}, voxel_m);
        DrillBone shared(bone.bricks, bone.density, bone.revision);
        SceneMeta meta{};
        meta.world_per_model = 1.0;
        DrillSettings settings;
        settings.tool.radius_m = radius_m;
        settings.tool.shaft_radius_m = 0.0;
        DrillModel model(meta, shared, settings);
        model.turn_burr({settings.rate_at_rad_s, step_s});
        Budget budget;
        budget.fidelity = fidelity;
        const double span_m = std::min(0.3 * edge * voxel_m, 10.0 * radius_m);
        auto& reference_n = full_level_n[{state.range(0), state.range(1), state.range(2)}];
        if (fidelity == 1.0F) reference_n.clear();
        const int steps = static_cast<int>(1.0 / step_s);
        Vec3 before_n = Vec3::Zero();
        for (int i = 0; i < steps; ++i) {
            const double t = step_s * i, travel_m = std::fmod(0.06 * t, 2.0 * span_m);
            const double depth_m = t < 0.3 ? t / 0.3 * 1e-3 : 1e-3 + 3e-3 * (t - 0.3);
            ToolState tool;
            tool.T_world_tool.p_m =
                Vec3((travel_m < span_m ? travel_m : 2.0 * span_m - travel_m) - 0.5 * span_m,
                     0.1 * radius_m * std::sin(9.0 * t), radius_m - depth_m);
            if (i == 0) model.reset(tool);
            const double predicted_us = to_us(model.predict(fidelity).cost_predicted);
            const StepResult result = model.step(tool, budget);
            const Vec3 force_n = result.wrench_world.force_n;
            if (fidelity == 1.0F) reference_n.push_back(force_n);
            const double moved_n = (force_n - before_n).norm();
            before_n = force_n;
            if (t < 0.3) continue;
            const Vec3 centre = bone.bricks.to_voxels(tool.T_world_tool.p_m);
            const double radius = radius_m / voxel_m;
            const Instant begin = Monotonic::now();
            BallMoments m =
                ball_moments(shared.octree, best_brick_kernels(), centre, radius,
                             DrillModel::detail_of(fidelity).asked(model.depth()) * radius, model.depth());
            benchmark::DoNotOptimize(m.m0);
            force_us.push_back(to_us(Monotonic::now() - begin));
            us.push_back(to_us(result.load.cost));
            ratio.push_back(predicted_us / us.back());
            items.push_back(result.load.items);
            error_n.push_back(result.load.error);
            step_n.push_back(moved_n);
            if (static_cast<std::size_t>(i) < reference_n.size())
                off_n.push_back((force_n - reference_n[static_cast<std::size_t>(i)]).norm());
        }
        removed_mm3 = 1e9 * model.removed_m3();
    }
    state.counters["us_p50"] = quantile(us, 0.5);
    state.counters["us_p99"] = quantile(us, 0.99);
    state.counters["us_p999"] = quantile(us, 0.999);
    state.counters["force_us_p50"] = quantile(force_us, 0.5);
    state.counters["items_p50"] = quantile(items, 0.5);
    state.counters["error_n_p50"] = quantile(error_n, 0.5);
    state.counters["n_off_p50"] = quantile(off_n, 0.5);
    state.counters["n_off_max"] = quantile(off_n, 1.0);
    state.counters["n_step_p99"] = quantile(step_n, 0.99);
    state.counters["n_step_max"] = quantile(step_n, 1.0);
    state.counters["predicted_p50"] = quantile(ratio, 0.5);
    state.counters["removed_mm3"] = removed_mm3;
}
// The full level runs first, as the reference for the other levels.
void sweep(benchmark::internal::Benchmark* b) {
    for (const auto& [r, h] : {std::pair{30, 3}, {200, 3}, {30, 1}, {200, 1}})
        for (const int hz : {1000, 4000})
            for (const int percent : {100, 75, 50, 25, 0})
                if (hz == 1000 || (r == 200 && h == 1)) b->Args({r, h, hz, percent});
}
BENCHMARK(level)
    ->ArgNames({"r", "h", "hz", "level"})
    ->Apply(sweep)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
