// Time of a drilling step of the servo, force and erosion together: a burr moves to and fro in bone and sinks into it.
//
// Arguments  r, h: burr radius and voxel size in tenths of a millimetre; shaft: 1 with shaft, 0 without
// Stroke     60 mm/s to and fro, sinking by 0.6 R in the first second; default level; solid bone with a grain. Voxels
//            of 0.1 mm: 512^3 if the environment variable TACT_BENCH_LARGE is set, otherwise 192^3.
// Metrics    step_us: time of DrillModel::step(); bricks: bricks changed per step; mhz: median speed of a counting loop
//            between the steps, as a reference for the machine
// Kernels    ns for one brick at the surface of a ball of 10 voxels (sum, erode), for sixteen cuts (cut16), and to
//            update the moments of a brick (pull)
// Measured   see rt/force/drilling/README.md
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

struct Bone {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    std::vector<std::uint32_t> revision;

    Bone(std::uint32_t edge, double voxel_m) {
        bricks.size = {edge, edge, edge};
        bricks.voxel_m = voxel_m;
        bricks.origin_m = -voxel_m * Vec3::Constant(0.5 * edge - 0.5);
        density.resize(bricks.bytes());
        revision.resize(bricks.brick_count());
        for (std::uint32_t z = 0; z < edge / 2; ++z) {
            for (std::uint32_t y = 0; y < edge; ++y) {
                for (std::uint32_t x = 0; x < edge; ++x)
                    density[bricks.voxel(x, y, z)] =
                        static_cast<std::uint8_t>(200 + (x * 7 + y * 13 + z * 29) % 56);
            }
        }
    }
};

double counting_mhz() {
    constexpr int kCounts = 2000;
    std::uint64_t value = 1;
    const Instant begin = Monotonic::now();
    for (int i = 0; i < kCounts; ++i) {
        value += 1;
        benchmark::DoNotOptimize(value);
    }
    return kCounts / std::max(to_us(Monotonic::now() - begin), 1e-3);
}

double quantile(std::vector<double>& values, double fraction) {
    std::sort(values.begin(), values.end());
    return values.empty()
               ? 0.0
               : values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

void stroke(benchmark::State& state) {
    const double radius_m = 1e-4 * static_cast<double>(state.range(0)),
                 voxel_m = 1e-4 * static_cast<double>(state.range(1));
    const bool large = std::getenv("TACT_BENCH_LARGE") != nullptr;
    const std::uint32_t edge = large && state.range(1) == 1 ? 512 : radius_m > 1e-2 ? 320 : 192;
    std::vector<double> us, mhz, build_ms;
    double bricks = 0.0, depth = 0.0, removed_mm3 = 0.0;
    std::size_t steps = 0;
    for (auto _ : state) {
        Bone bone(edge, voxel_m);
        const Instant begin = Monotonic::now();
        DrillBone shared(bone.bricks, bone.density, bone.revision);
        build_ms.push_back(to_us(Monotonic::now() - begin) * 1e-3);
        SceneMeta meta{};
        meta.world_per_model = 1.0;
        DrillSettings settings;
        settings.tool.radius_m = radius_m;
        settings.tool.shaft_radius_m = state.range(2) != 0 ? 1e-3 : 0.0;
        settings.tool.shaft_length_m = std::max(settings.tool.shaft_length_m, 2.0 * radius_m + 0.02);
        settings.rate_per_s = 20.0;
        DrillModel model(meta, shared, settings);
        model.turn_burr({settings.rate_at_rad_s, 1e-3});
        Budget budget;
        budget.fidelity = model.knob().start;
        const double span_m = std::min(0.3 * edge * voxel_m, 10.0 * radius_m);
        for (int i = 0; i < 1500; ++i) {
            const double t = 1e-3 * i, travel_m = std::fmod(0.06 * t, 2.0 * span_m);
            ToolState tool;
            tool.T_world_tool.p_m =
                Vec3((travel_m < span_m ? travel_m : 2.0 * span_m - travel_m) - 0.5 * span_m,
                     0.3 * radius_m * std::sin(9.0 * t), radius_m * (0.9 - 0.6 * std::min(1.0, t)));
            if (i == 0) model.reset(tool);
            mhz.push_back(counting_mhz());
            StepResult result = model.step(tool, budget);
            benchmark::DoNotOptimize(result.wrench_world.force_n.x());
            if (i < 300) continue;  // the force is still fading in
            us.push_back(to_us(result.load.cost));
            bricks += model.cut().bricks;
            depth += model.depth();
            ++steps;
        }
        removed_mm3 = static_cast<double>(model.removed_levels()) / 255.0 * std::pow(1e3 * voxel_m, 3.0);
    }
    const auto n = static_cast<double>(steps);
    state.counters["step_us_p50"] = quantile(us, 0.5);
    state.counters["step_us_p99"] = quantile(us, 0.99);
    state.counters["bricks"] = bricks / n;
    state.counters["depth"] = depth / n;
    state.counters["removed_mm3"] = removed_mm3;
    state.counters["build_ms"] = quantile(build_ms, 0.5);
    state.counters["mhz"] = quantile(mhz, 0.5);
}
BENCHMARK(stroke)
    ->ArgNames({"r", "h", "shaft"})
    ->Args({30, 3, 0})
    ->Args({30, 3, 1})
    ->Args({50, 3, 0})
    ->Args({30, 1, 0})
    ->Args({200, 3, 0})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

template <class Work>
void each(benchmark::State& state, const Work& work) {
    std::vector<std::uint8_t> voxels(64 * BoneBricks::kVoxels, 200);
    std::uint32_t i = 0;
    for (auto _ : state) {
        ++i;
        work(voxels.data() + BoneBricks::kVoxels * (i % 64), i);
    }
}

void kernels(benchmark::State& state, const BrickKernels* k, int which) {
    if (!k->runs_here()) return state.SkipWithError("not on this processor");
    const SumJob sum{{-12.0F, -3.5F, -3.5F}, 100.0F - 1.0F / 12, 0.0775F};
    ErodeJob erode{{-12.0F, -3.5F, -3.5F}, {0.1F, 0.2F, 0.05F}, 0.01F, 1e-6F, 1.0F, 0.0F, 0};
    CutBlocks cuts{};
    for (std::size_t c = 0; c < kCuts; ++c) {
        cuts.centre[0][c] = 9.0F;
        cuts.centre[1][c] = 0.3F * static_cast<float>(c);
        cuts.edge[c] = 4.0F;
        cuts.limit[c] = 9.8F;
        cuts.m0[c] = 9000.0F;
    }
    each(state, [&](std::uint8_t* voxels, std::uint32_t i) {
        BrickSums sums;
        if (which == 0) {
            k->sum(sum, voxels, sums);
            benchmark::DoNotOptimize(sums.m0);
        } else if (which == 1) {
            erode.key = i;
            benchmark::DoNotOptimize(k->erode(erode, voxels));
        } else {
            cuts.centre[2][0] = static_cast<float>(i % 8);
            k->cut(cuts);
            benchmark::DoNotOptimize(cuts.cut_m0[0]);
        }
    });
}

const int kRegistered = [] {
    constexpr const char* kWhat[] = {"sum/", "erode/", "cut16/"};
    for (std::size_t k = 0; k < kBrickKernelCount; ++k) {
        for (int which = 0; which < 3; ++which)
            benchmark::RegisterBenchmark((std::string(kWhat[which]) + kBrickKernels[k].name).c_str(),
                                         &kernels, &kBrickKernels[k], which);
    }
    return 0;
}();

void pull(benchmark::State& state) {
    each(state, [](std::uint8_t* voxels, std::uint32_t) {
        MomentOctree::Parts parts;
        MomentOctree::Brick brick;
        pull_brick(voxels, parts, brick);
        benchmark::DoNotOptimize(brick.m0);
    });
}
BENCHMARK(pull);

}  // namespace
}  // namespace tact
