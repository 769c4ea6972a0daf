#include "prep/cli/simplify_command.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "prep/console/console.hpp"
#include "prep/console/target.hpp"
#include "prep/mesh/mesh_folds.hpp"
#include "prep/mesh/simplify_to_keep.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "prep/mesh_file/write_ply.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct SimplifyOptions {
    std::string in, out;
    KeepSettings settings;
    bool json = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void simplify_file(const SimplifyOptions& o) {
    check_target("write mesh", o.out, {o.in});
    Console console;
    const Progress progress = console.progress();
    const auto begin = std::chrono::steady_clock::now();
    const ImportedMesh in = import_mesh(o.in, part(progress, 0.0, 0.2));
    const TriangleMesh mesh = cleaned(in.mesh);
    if (mesh.triangles() == 0)
        throw StartupError("simplify " + o.in, "no triangle has three different corners",
                           "export the mesh again");
    const double read_s = seconds_since(begin);
    const auto start = std::chrono::steady_clock::now();
    const Kept kept = simplify_to_keep(mesh, o.settings, part(progress, 0.2, 0.98));
    const Simplified& result = kept.simplified;
    const double simplify_s = seconds_since(start);
    report(progress, 0.99, "writing the mesh");
    write_ply(o.out, result.mesh);
    console.clear();
    const float error = result.contraction.empty() ? 0.0F : result.contraction.back().error_m;
    const std::size_t folds = count_folds(result.mesh);
    if (o.json) {
        const nlohmann::ordered_json json{{"format", in.format},
                                          {"vertices_in", mesh.vertices()},
                                          {"triangles_in", mesh.triangles()},
                                          {"folds_in", count_folds(mesh)},
                                          {"vertices", result.mesh.vertices()},
                                          {"triangles", result.mesh.triangles()},
                                          {"folds", folds},
                                          {"boundary_weight", kept.boundary_weight},
                                          {"error", error},
                                          {"seconds", simplify_s},
                                          {"read_seconds", read_s}};
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    std::printf("%s: %zu vertices, %zu triangles (%s)\n", o.in.c_str(), mesh.vertices(), mesh.triangles(),
                in.format.c_str());
    std::printf("%s: %zu vertices, %zu triangles, error %.3g in the file's unit, %zu folds, %.2f s\n",
                o.out.c_str(), result.mesh.vertices(), result.mesh.triangles(), static_cast<double>(error),
                folds, simplify_s);
    if (result.mesh.vertices() > o.settings.vertices_min)
        std::printf(
            "Fewer vertices would change the topology of the mesh%s.\n",
            o.settings.pair_distance > 0.0 ? "" : "; --pair-distance 1 allows parts to join or vanish");
}

}  // namespace

std::function<void()> add_simplify(CLI::App& app, CLI::App*& command) {
    const auto o = std::make_shared<SimplifyOptions>();
    command = app.add_subcommand("simplify", "Simplify a triangle mesh by pair contraction");
    command->add_option("mesh", o->in, "Triangle mesh: PLY, OBJ, STL or OFF, also .gz")->required();
    command->add_option("-o,--output", o->out, "PLY file to write")->required()->type_name("FILE.ply");
    command->add_option("--vertices", o->settings.vertices_min, "Maximum number of vertices of the result")
        ->required()
        ->check(CLI::Range(1U, 1U << 28U));
    command
        ->add_option("--boundary-weight", o->settings.boundary_weight,
                     "Weight of boundary edges relative to the surface (published method: 1000; default: "
                     "100, on open meshes of up to 20000 triangles the best of four values)")
        ->check(CLI::Range(0.0, 1e6));
    command
        ->add_option(
            "--pair-distance", o->settings.pair_distance,
            "Maximum distance of vertices without a common edge that are contracted too (mean edge lengths)")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command
        ->add_option("--relax", o->settings.relax_rounds,
                     "Number of rounds that move the remaining vertices towards the original surface; 0: "
                     "none (default: 1; up to 40 for open meshes with few vertices)")
        ->check(CLI::Range(0U, 100U));
    command->add_flag("--json", o->json, "Print the result as JSON");
    return [o] { simplify_file(*o); };
}

}  // namespace tact
