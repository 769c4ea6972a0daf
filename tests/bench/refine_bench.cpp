// Processor time of one refinement step around a moving probe, on a rough torus.
//
// Cases     Moving: the probe moves by 1 % of the diagonal per step; full detail within 5 % of the diagonal (Chebyshev
//           distance), a bell filter beyond. MovingSteep, MovingSteepest: narrower bells. Still: the probe is at rest.
//           40,000 vertices; a million if the environment variable TACT_BENCH_LARGE is set.
// Metrics   step_us: processor time of the thread per step; ops: splits and merges per step; active: active vertices;
//           late: number of steps that did not reach full detail
// Measured  see rt/force/surface/REFINEMENT.md
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "ipc/scene/mesh/refinement.hpp"
#include "prep/surface/forest_builder.hpp"
#include "prep/synthetic/rough_torus.hpp"

namespace tact {
namespace {

double thread_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Torus {
    std::uint32_t n = std::getenv("TACT_BENCH_LARGE") != nullptr ? 1000 : 200;
    TriangleMesh mesh = rough_torus(n, n);
    BuiltForest built = build_forest(mesh);
    VertexForest forest = view_forest(built.data, mesh.position_m, mesh.triangle);
    double diagonal_m = std::sqrt(2.6 * 2.6 * 2 + 0.6 * 0.6);
};

void run(benchmark::State& state, double step_size, double width = 0.05, double far = 0.02) {
    static const Torus torus;
    RefinementSettings settings;
    const auto part = [&](double fraction) { return static_cast<float>(fraction * torus.diagonal_m); };
    settings.filter = RefineFilter::bell(part(0.05), part(width), part(far));
    settings.look_ahead_s = 0.0;
    Refinement refinement(torus.forest, settings);
    for (int i = 0; i < 60; ++i) refinement.step(Vec3(1.0, 0.0, 0.3), Vec3::Zero());
    std::vector<double> step_us;
    double angle = 0.0, ops = 0.0, active = 0.0, late = 0.0;
    for (auto _ : state) {
        angle += step_size * torus.diagonal_m;
        const double before = thread_s();
        const RefineStep done = refinement.step(Vec3(std::cos(angle), std::sin(angle), 0.3), Vec3::Zero());
        step_us.push_back(1e6 * (thread_s() - before));
        ops += done.splits + done.merges;
        active += done.vertices;
        late += done.full_detail ? 0.0 : 1.0;
    }
    std::sort(step_us.begin(), step_us.end());
    const auto count = static_cast<double>(step_us.size());
    state.counters["step_us_p50"] = step_us[step_us.size() / 2];
    state.counters["step_us_p99"] = step_us[step_us.size() * 99 / 100];
    state.counters["step_us_max"] = step_us.back();
    state.counters["ops"] = ops / count;
    state.counters["active"] = active / count;
    state.counters["late"] = late;
    state.counters["state_MB"] = 1e-6 * static_cast<double>(refinement.memory_bytes());
}

void Moving(benchmark::State& state) { run(state, 0.01); }
void MovingSteep(benchmark::State& state) { run(state, 0.01, 0.025, 0.04); }
void MovingSteepest(benchmark::State& state) { run(state, 0.01, 0.01, 0.1); }
void Still(benchmark::State& state) { run(state, 0.0); }
BENCHMARK(Moving)->Unit(benchmark::kMicrosecond);
BENCHMARK(MovingSteep)->Unit(benchmark::kMicrosecond);
BENCHMARK(MovingSteepest)->Unit(benchmark::kMicrosecond);
BENCHMARK(Still)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tact
