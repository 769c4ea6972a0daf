#include "prep/cli/bench_command.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/relax.hpp"
#include "prep/synthetic/rough_torus.hpp"
#include "prep/synthetic/two_rings.hpp"

namespace tact {
namespace {

constexpr int kRuns = 3;  // the key says so too

// CPU time of this process, to reduce the effect of other load.
double processor_s() {
    std::timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Simplified simplified(const TriangleMesh& mesh, std::uint32_t vertices) {
    Simplified result = simplify(mesh, {.vertices_min = vertices});
    relax(mesh, result, 1);
    return result;
}

nlohmann::ordered_json bench() {
    const TriangleMesh torus = rough_torus(500, 400);
    double first_s = 0.0, best_s = 1e9;
    for (int i = 0; i < kRuns; ++i) {
        const Instant start = Monotonic::now();
        const double start_s = processor_s();
        simplified(torus, 2000);
        best_s = std::min(best_s, processor_s() - start_s);
        if (i == 0) first_s = to_s(Monotonic::now() - start);
    }
    const double mtri = 1e-6 * static_cast<double>(torus.triangles());
    const TriangleMesh rings = isosurface(two_rings_map(), kTwoRingsContour);
    const double diagonal_m = MeshGrid(rings).diagonal_m();
    const auto rms_pct = [&](std::uint32_t vertices) {
        return 100.0 * two_sided(rings, simplified(rings, vertices).mesh, 20000).rms_m / diagonal_m;
    };
    return {{"simplify_mtri_per_s", mtri / first_s},
            {"simplify_mtri_per_s_best_of_3_processor", mtri / best_s},
            {"simplify_rms_2000", rms_pct(2000)},
            {"simplify_rms_200", rms_pct(200)}};
}

}  // namespace

std::function<void()> add_bench(CLI::App& app, CLI::App*& command) {
    command = app.add_subcommand(
        "bench",
        "Measure the speed of mesh simplification (million triangles/s, in one run, and the "
        "best of three by processor time) and its error (RMS, % of the diagonal)");
    const auto as_json = std::make_shared<bool>(false);
    command->add_flag("--json", *as_json, "Print as JSON");
    return [as_json] {
        const nlohmann::ordered_json numbers = bench();
        if (*as_json) {
            std::printf("%s\n", numbers.dump(2).c_str());
            return;
        }
        for (const auto& [key, value] : numbers.items())
            std::printf("%-40s %.4g\n", key.c_str(), value.get<double>());
    };
}

}  // namespace tact
