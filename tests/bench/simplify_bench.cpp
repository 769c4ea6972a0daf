// Time and two-sided error of mesh simplification; time to change the detail of a progressive mesh.
//
// Shapes    the isosurface of two rings of seven blobs in a map of 73³ voxels (12,424 vertices); an open sheet of 1,250
//           triangles. Only if the environment variable TACT_BENCH_LARGE is set, because they take half a minute: rough
//           tori of one and two million triangles.
// Metrics   rms_pct, max_pct: error in percent of the diagonal of the box; sharp: smallest cosine between adjacent
//           triangles; copy_ms: time of a plain copy of the buffers of the level, as a reference for the machine
//
// Measured 2026-11-21 on two shared, loaded cores of 2.6 GHz; processor time:
//   rings -> 2000 / 200           16 / 18 ms   rms 0.070 / 0.67 %, relaxed 0.0625 / 0.55 %
//   sheet -> 100 / 8              f = none to 1000: README.md of prep/mesh; f = 100 is the default
//   1 M triangles -> 5,000        0.9 s        at most 236 bytes per vertex
//   walks of a million vertices   see mesh_cut.cpp
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "ipc/scene/density/isosurface.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"
#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/mesh/relax.hpp"
#include "prep/synthetic/rough_torus.hpp"
#include "prep/synthetic/two_rings.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::test {
namespace {

const TriangleMesh& rings() {
    static const TriangleMesh mesh = isosurface(two_rings_map(), kTwoRingsContour);
    return mesh;
}

const TriangleMesh& million() {
    static const TriangleMesh mesh = rough_torus(1000, 500);
    return mesh;
}

const TriangleMesh& sheet() {
    static const TriangleMesh mesh = [] {
        TriangleMesh made;
        for (std::uint32_t y = 0; y <= 25; ++y) {
            for (std::uint32_t x = 0; x <= 25; ++x) {
                const float u = static_cast<float>(x) / 25.0F, v = static_cast<float>(y) / 25.0F;
                made.position_m.insert(
                    made.position_m.end(),
                    {u, v + 0.1F * std::sin(4.0F * u), 0.15F * std::sin(5.0F * u) * std::cos(4.0F * v)});
                if (x == 25 || y == 25) continue;
                const std::uint32_t a = y * 26 + x;
                made.triangle.insert(made.triangle.end(), {a, a + 1, a + 27, a, a + 27, a + 26});
            }
        }
        return made;
    }();
    return mesh;
}

void simplify_to(benchmark::State& state, const TriangleMesh& (*shape)(), double boundary_weight,
                 std::uint32_t relax_rounds = 0) {
    const TriangleMesh& mesh = shape();
    const SimplifySettings settings{.vertices_min = static_cast<std::uint32_t>(state.range(0)),
                                    .boundary_weight = boundary_weight};
    Simplified result;
    for (auto _ : state) {
        result = simplify(mesh, settings);
        relax(mesh, result, relax_rounds);
    }
    const MeshDistance d = two_sided(mesh, result.mesh);
    const double diagonal_m = MeshGrid(mesh).diagonal_m();
    state.counters["rms_pct"] = 100.0 * d.rms_m / diagonal_m;
    state.counters["max_pct"] = 100.0 * d.max_m / diagonal_m;
    state.counters["sharp"] = topology(result.mesh).sharpest;
}

void bake(benchmark::State& state) {
    ProgressiveMeshData data;
    for (auto _ : state) data = make_progressive(rings());
    state.counters["bytes_per_vertex"] =
        static_cast<double>(ProgressiveMesh(data).memory_bytes()) / static_cast<double>(rings().vertices());
}

// Changes from one number of vertices to another (in thousandths of all). The change back is not timed.
void jump(benchmark::State& state, const ProgressiveMesh& (*shape)()) {
    const ProgressiveMesh& mesh = shape();
    MeshCut cut(mesh);
    const auto level = [&](std::int64_t per_mille) {
        return static_cast<std::uint32_t>(mesh.vertices() * per_mille / 1000);
    };
    for (auto _ : state) {
        state.PauseTiming();
        cut.set_vertices(level(state.range(0)));
        (void)cut.changes();
        state.ResumeTiming();
        cut.set_vertices(level(state.range(1)));
        benchmark::DoNotOptimize(cut.changes());
    }
    const auto vertex = cut.vertex().first(cut.vertices());
    const auto index = cut.index().first(std::size_t{3} * cut.triangles());
    std::vector<std::byte> copy(vertex.size_bytes() + index.size_bytes());
    double best_ms = 1e9;
    for (int i = 0; i < 5; ++i) {
        const auto start = std::chrono::steady_clock::now();
        std::memcpy(copy.data(), vertex.data(), vertex.size_bytes());
        std::memcpy(copy.data() + vertex.size_bytes(), index.data(), index.size_bytes());
        benchmark::ClobberMemory();
        best_ms = std::min(
            best_ms,
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    state.counters["copy_ms"] = best_ms;
}

const ProgressiveMesh& progressive_rings() {
    static const ProgressiveMesh mesh(make_progressive(rings()));
    return mesh;
}
const ProgressiveMesh& progressive_million() {  // a million vertices, two million triangles
    static const ProgressiveMesh mesh(make_progressive(rough_torus(1250, 800)));
    return mesh;
}

BENCHMARK_CAPTURE(simplify_to, rings, rings, SimplifySettings{}.boundary_weight)
    ->Arg(2000)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simplify_to, rings_relaxed, rings, SimplifySettings{}.boundary_weight, 1)
    ->Arg(2000)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simplify_to, sheet_f_default, sheet, SimplifySettings{}.boundary_weight)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_none, sheet, 0.0)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_1, sheet, 1.0)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_10, sheet, 10.0)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_10_relaxed, sheet, 10.0, 1)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_100, sheet, 100.0)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_100_relaxed, sheet, 100.0, 1)->Arg(100)->Arg(8);
BENCHMARK_CAPTURE(simplify_to, sheet_f_published, sheet, kPublishedBoundaryWeight)->Arg(100)->Arg(8);
BENCHMARK(bake)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(jump, rings, progressive_rings)->Args({1000, 280})->Unit(benchmark::kMillisecond);

[[maybe_unused]] const bool large = [] {
    if (std::getenv("TACT_BENCH_LARGE") == nullptr) return false;
    benchmark::RegisterBenchmark("simplify_to/million", simplify_to, million,
                                 SimplifySettings{}.boundary_weight, 1U)
        ->Arg(5000)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("jump/million", jump, progressive_million)
        ->Args({1000, 280})
        ->Args({280, 1000})
        ->Args({280, 900})
        ->Args({500, 499})
        ->Args({499, 500})
        ->Unit(benchmark::kMillisecond);
    return true;
}();

}  // namespace
}  // namespace tact::test
