// Time of the clash force: a ball of protein of 3500 atoms moves among others.
//
// Arguments  number of other bodies; distance of their centres in angstrom (the radii are 25, so 48 is contact)
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "ipc/base/random.hpp"
#include "rt/force/docking/clash_force.hpp"

namespace tact {
namespace {

constexpr double kA = 1e-10;

Structure ball() {
    Structure s;
    s.name = "ball";
    SeededRandom random(1);
    for (int i = 0; i < 3500; ++i) {
        const Vec3 p = 25.0 * kA * std::cbrt(random.uniform()) * random.direction();
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
    }
    return s;
}

void clash(benchmark::State& state) {
    static const ClashField field(ball());
    std::vector<ClashBody> others;
    SeededRandom random(2);
    for (int k = 0; k < state.range(0); ++k) {
        const Vec3 away = static_cast<double>(state.range(1)) * kA * random.direction();
        others.push_back({&field, {away, random.rotation()}});
    }
    int i = 0;
    std::uint32_t points = 0;
    for (auto _ : state) {
        ++i;  // the body moves slightly, as in a hand
        const Pose pose{kA * Vec3(std::sin(1e-3 * i), std::cos(2e-3 * i), std::sin(3e-3 * i)),
                        quat_from_rotation_vector(0.1 * Vec3(std::cos(1e-3 * i), std::sin(1e-3 * i), 0.5))};
        ClashResult result = clash_force({&field, pose}, others, 6e6, {});
        points = result.points;
        benchmark::DoNotOptimize(result);
    }
    state.counters["points"] = points;
}
BENCHMARK(clash)->ArgsProduct({{1, 5, 15}, {48, 60}})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tact
