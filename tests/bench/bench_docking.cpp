#include "tests/bench/bench_docking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "ipc/base/random.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "tests/bench/loop_thread.hpp"

namespace tact {
namespace {

constexpr double kVoxelM = 2e-10;
constexpr std::uint32_t kSide = 128;
constexpr std::size_t kAtoms = 100'000, kVectors = 200;
// Heavy atoms of protein: one per about 18 cubic angstrom.
constexpr double kAtomVolumeM3 = 18e-30;

// A smooth pattern: gradients are nonzero everywhere, and no value is denormal or constant.
DensityGrid make_map() {
    DensityGrid grid;
    grid.size = {kSide, kSide, kSide};
    grid.spacing_m = Vec3::Constant(kVoxelM);
    grid.values.resize(grid.count());
    for (std::uint32_t z = 0; z < kSide; ++z) {
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const double v = std::sin(0.21 * x) * std::cos(0.17 * y) +
                                 std::sin(0.13 * z + 0.05 * x) * std::cos(0.3 * y);
                grid.values[(std::size_t{z} * kSide + y) * kSide + x] = static_cast<float>(v);
            }
        }
    }
    return grid;
}

// Points of uniform density in a ball, in random order as in a file.
std::array<std::vector<float>, 4> ball(std::size_t count, double radius_m, SeededRandom& random) {
    std::array<std::vector<float>, 4> out;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p = radius_m * std::cbrt(random.uniform()) * random.direction();
        for (std::size_t a = 0; a < 3; ++a)
            out[a].push_back(static_cast<float>(p[static_cast<Eigen::Index>(a)]));
        out[3].push_back(1.0F / static_cast<float>(count));
    }
    return out;
}

DockingModel make_model() {
    SeededRandom random(1);
    const double radius_m =
        std::cbrt(kAtomVolumeM3 * static_cast<double>(kAtoms) * 3.0 / (4.0 * std::numbers::pi));
    SceneMeta meta{};
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 0.15 / (kVoxelM * kSide);
    meta.energy_j_per_sigma = 0.01;
    meta.map_sigma = 1.0;
    meta.resolution_m = 4.0 * kVoxelM;
    Structure body;
    body.name = "bench";
    body.home_com_model_m = Vec3::Constant(0.5 * kVoxelM * kSide);
    auto atoms = ball(kAtoms, radius_m, random);
    body.x_m = std::move(atoms[0]), body.y_m = std::move(atoms[1]), body.z_m = std::move(atoms[2]);
    body.mass_fraction = std::move(atoms[3]);
    auto vectors = ball(kVectors, radius_m, random);
    Codebook::Level level;
    level.x_m = std::move(vectors[0]), level.y_m = std::move(vectors[1]), level.z_m = std::move(vectors[2]);
    level.weight = std::move(vectors[3]);
    Codebook codebook;
    codebook.levels.push_back(std::move(level));
    return {meta, make_map(), {std::move(body)}, {std::move(codebook)}, DockingSettings{}};
}

// A slow motion through a few voxels and a few degrees, relative to the home pose of the body.
Pose pose_at(int step) {
    return {3.0 * kVoxelM * Vec3(std::sin(1e-3 * step), std::cos(2e-3 * step), std::sin(3e-3 * step)),
            quat_from_rotation_vector(0.1 * Vec3(std::cos(1e-3 * step), std::sin(1e-3 * step), 0.5))};
}

// Times of whole steps at 1 kHz. The first tenth of the steps is a warm-up and is not counted.
Percentiles loop_us(DockingModel& model, float fidelity, int steps) {
    const Budget budget{.fidelity = fidelity};
    std::vector<double> times_us;
    times_us.reserve(static_cast<std::size_t>(steps));
    run_as_loop(kServoPriority, [&] {
        ToolState tool;
        const auto move_hand = [&](int i) {
            tool.T_world_tool = pose_at(i);
            tool.T_world_tool.p_m *= model.meta().world_per_model;
        };
        move_hand(0);
        model.reset(tool);
        LoopPace pace(1e-3);
        for (int i = 0; i < steps + steps / 10; ++i) {
            move_hand(i);
            pace.wait();
            const Instant begin = Monotonic::now();
            model.drive({});
            static_cast<void>(model.step(tool, budget));
            const Instant end = Monotonic::now();
            if (i >= steps / 10) times_us.push_back(to_us(end - begin));
        }
    });
    return percentiles(times_us);
}

// The smallest median over twenty series of `count` forces each.
double best_of_20_us(const DockingModel& model, float fidelity, int count) {
    const Budget budget{.fidelity = fidelity};
    double least_us = 1e300, sink = 0.0;
    for (int k = 0; k < 20; ++k) {
        std::vector<double> times_us;
        for (int i = 0; i < count; ++i) {
            Pose pose = pose_at(k * count + i);
            pose.p_m += model.home().p_m;
            const Instant begin = Monotonic::now();
            const StepResult result = model.evaluate(pose, budget);
            times_us.push_back(to_us(Monotonic::now() - begin));
            sink += result.wrench_world.force_n.x();
        }
        least_us = std::min(least_us, percentile(times_us, 0.5));
    }
    return std::isfinite(sink) ? least_us : 0.0;
}

}  // namespace

DockingBench bench_docking(const DockingBenchSettings& settings) {
    DockingModel model = make_model();
    DockingBench bench;
    bench.kernel = model.map().kernel_name();
    bench.map_bytes = model.map().bytes();
    bench.force_us_n200 = loop_us(model, 0.0F, settings.steps);
    bench.force_us_atoms100k = loop_us(model, 1.0F, settings.steps);
    bench.force_us_n200_best_of_20 = best_of_20_us(model, 0.0F, settings.stretch_n200);
    bench.force_us_atoms100k_best_of_20 = best_of_20_us(model, 1.0F, settings.stretch_atoms100k);
    bench.ns_per_point_n200 = 1e3 * bench.force_us_n200.p50 / static_cast<double>(kVectors);
    bench.ns_per_point_atoms = 1e3 * bench.force_us_atoms100k.p50 / static_cast<double>(kAtoms);
    return bench;
}

}  // namespace tact
