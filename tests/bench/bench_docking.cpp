#include "tests/bench/bench_docking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "ipc/base/random.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact {
namespace {

constexpr double kVoxelM = 2e-10;
constexpr std::uint32_t kSide = 128;
constexpr std::size_t kAtoms = 100'000, kVectors = 200;
// Heavy atoms of protein: one per about 18 cubic angstrom.
constexpr double kAtomVolumeM3 = 18e-30;

// Smooth noise, so that gradients are nonzero everywhere and no value is denormal or constant.
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

struct Times {
    double p50_us = 0.0, p99_us = 0.0, quietest_us = 0.0;
};

// The minimum of the medians of consecutive series.
double least_median(std::vector<double> times) {
    constexpr std::size_t kStretches = 20;
    const std::size_t length = std::max<std::size_t>(times.size() / kStretches, 1);
    double least = times.front();
    for (std::size_t k = 0; (k + 1) * length <= times.size(); ++k) {
        const auto begin = times.begin() + static_cast<std::ptrdiff_t>(k * length);
        const auto middle = begin + static_cast<std::ptrdiff_t>(length / 2);
        std::nth_element(begin, middle, begin + static_cast<std::ptrdiff_t>(length));
        least = k == 0 ? *middle : std::min(least, *middle);
    }
    return least;
}

Times measure(const DockingModel& model, float fidelity, int steps) {
    Budget budget;
    budget.fidelity = fidelity;
    std::vector<double> times_us;
    Pose pose = model.home();
    double sink = 0.0;
    for (int i = 0; i < steps + steps / 10; ++i) {
        // A slow curve through some voxels and a few degrees.
        pose.p_m = model.home().p_m +
                   3.0 * kVoxelM * Vec3(std::sin(1e-3 * i), std::cos(2e-3 * i), std::sin(3e-3 * i));
        pose.q = quat_from_rotation_vector(0.1 * Vec3(std::cos(1e-3 * i), std::sin(1e-3 * i), 0.5));
        const Instant begin = Monotonic::now();
        const StepResult result = model.evaluate(pose, budget);
        const Instant end = Monotonic::now();
        sink += result.wrench_world.force_n.x();
        if (i >= steps / 10) times_us.push_back(to_us(end - begin));
    }
    if (!std::isfinite(sink)) return {};
    const double quietest_us = least_median(times_us);
    std::sort(times_us.begin(), times_us.end());
    return {times_us[times_us.size() / 2], times_us[times_us.size() * 99 / 100], quietest_us};
}

}  // namespace

DockingBench bench_docking(const DockingBenchSettings& settings) {
    const DockingModel model = make_model();
    DockingBench bench;
    bench.kernel = model.map().kernel_name();
    bench.map_bytes = model.map().bytes();
    const Times reduced = measure(model, 0.0F, settings.steps_n200),
                all = measure(model, 1.0F, settings.steps_atoms100k);
    bench.force_us_n200_p50 = reduced.p50_us;
    bench.force_us_n200_p99 = reduced.p99_us;
    bench.force_us_n200_quietest = reduced.quietest_us;
    bench.force_us_atoms100k_p50 = all.p50_us;
    bench.force_us_atoms100k_p99 = all.p99_us;
    bench.force_us_atoms100k_quietest = all.quietest_us;
    bench.ns_per_point_n200 = 1e3 * reduced.p50_us / static_cast<double>(kVectors);
    bench.ns_per_point_atoms = 1e3 * all.p50_us / static_cast<double>(kAtoms);
    return bench;
}

}  // namespace tact
