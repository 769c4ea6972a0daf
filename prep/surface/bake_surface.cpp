#include "prep/surface/bake_surface.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "ipc/base/error.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/surface/build_surface.hpp"

namespace tact {
namespace {

void place(const SurfaceInput& input, SceneMeta& meta) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (std::size_t i = 0; i < input.mesh.position_m.size(); ++i) {
        const auto axis = static_cast<Eigen::Index>(i % 3);
        const auto x = static_cast<double>(input.mesh.position_m[i]);
        low[axis] = std::min(low[axis], x);
        high[axis] = std::max(high[axis], x);
    }
    const double diagonal_m = (high - low).norm();
    if (!(diagonal_m > 1e-12) || !std::isfinite(diagonal_m))
        throw StartupError("bake a surface",
                           "the diagonal of the mesh is " + std::to_string(diagonal_m) + " m",
                           "check the mesh and --unit");
    meta.world_per_model = input.size_m / diagonal_m;
    meta.centre_model_m[0] = 0.5 * (low.x() + high.x());
    meta.centre_model_m[1] = high.y() + SurfaceInput::kBelowM / meta.world_per_model;
    meta.centre_model_m[2] = 0.5 * (low.z() + high.z());
}

// Builds a forest over the triangles of the surface and renumbers the surface's vertices in its order.
VertexForestData plant(SurfaceData& surface, double locality, ForestShape& shape, const Progress& progress) {
    TriangleMesh mesh;
    mesh.position_m = std::move(surface.position_m);
    mesh.triangle = std::move(surface.triangle);
    BuiltForest built = build_forest(mesh, {.locality = locality}, progress);
    std::vector<OctNormal> normal(built.order.size());
    for (std::size_t v = 0; v < normal.size(); ++v) normal[v] = surface.normal[built.order[v]];
    surface.normal = std::move(normal);
    surface.position_m = std::move(mesh.position_m);
    surface.triangle = std::move(mesh.triangle);
    shape = shape_of(view_forest(built.data, surface.position_m, surface.triangle), surface.triangle);
    return std::move(built.data);
}

std::size_t bytes_of(const VertexForestData& forest) {
    return (forest.root_first.size() + forest.need.size()) * sizeof(std::uint32_t) +
           forest.node.size() * sizeof(ForestNode) + forest.triangle.size() * sizeof(ForestTriangle);
}

// Samples the tool in the model frame and moves the surface down until the tool at rest does not reach it.
void bake_tool(SurfaceInput& input, SceneWriter& out, BakedSurface& baked, const Progress& progress) {
    TriangleMesh& mesh = input.tool;
    if (input.tool_size_m > 0.0) {
        Eigen::Vector3f low = Eigen::Vector3f::Constant(3e38F), high = -low;
        for (std::size_t v = 0; v < mesh.vertices(); ++v) {
            const Eigen::Vector3f p = Eigen::Map<const Eigen::Vector3f>(mesh.position_m.data() + 3 * v);
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        const double diagonal_m = static_cast<double>((high - low).norm());
        if (!(diagonal_m > 1e-12) || !std::isfinite(diagonal_m))
            throw StartupError("bake a tool",
                               "the diagonal of the tool is " + std::to_string(diagonal_m) + " m",
                               "check the mesh of the tool");
        const auto scale = static_cast<float>(input.tool_size_m / diagonal_m / baked.meta.world_per_model);
        for (float& x : mesh.position_m) x *= scale;
    }
    const TouchTool tool = sample_tool(std::move(mesh), input.tool_sampling, progress);
    double lowest = 0.0, reach = 0.0;
    for (std::size_t i = 0; i < tool.points(); ++i) {
        lowest = std::min(lowest, tool.at_m(i).y());
        reach = std::max(reach, tool.at_m(i).norm());
    }
    baked.meta.centre_model_m[1] -= lowest;
    baked.tool_points = tool.points();
    const double mm = 1e3 * baked.meta.world_per_model;
    char line[200];
    std::snprintf(
        line, sizeof line,
        "tool: %zu points, %.3g mm apart in the workspace, at most %.3g mm from the grip point; ball radius "
        "%.3g mm\n",
        tool.points(), mm * static_cast<double>(tool.cover_m.back()), mm * reach, mm * tool.ball_m);
    baked.note += line;
    baked.tool_too_large = reach * baked.meta.world_per_model > input.size_m;
    write_touch_tool(out, tool);
}

}  // namespace

BakedSurface bake_surface(SurfaceInput&& input, SceneWriter& out, const Progress& progress) {
    BakedSurface baked;
    baked.meta.kind = SceneKind::surface;
    place(input, baked.meta);
    input.title.copy(baked.meta.title, sizeof baked.meta.title - 1);
    for (const std::string& line : input.note) baked.note += line + '\n';

    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    // The progress fractions were measured on a bake of 100 000 triangles, 2026-11-23.
    SurfaceData data = build_surface(input.mesh, part(progress, 0.0, 0.1));
    const auto built = Clock::now();
    baked.build_s = std::chrono::duration<double>(built - begin).count();
    VertexForestData forest;
    if (input.forest) {
        if (input.compare_locality) {
            SurfaceData copy = data;
            static_cast<void>(
                plant(copy, 0.0, baked.shape_without_locality.emplace(), part(progress, 0.1, 0.1)));
        }
        const auto planting = Clock::now();
        forest = plant(data, ForestSettings().locality, baked.shape.emplace(), part(progress, 0.1, 0.7));
        baked.forest_s = std::chrono::duration<double>(Clock::now() - planting).count();
    }
    baked.vertices = data.position_m.size() / 3;
    baked.triangles = data.triangle.size() / 3;
    baked.closed = data.closed;
    const std::size_t bytes = data.position_m.size() * sizeof(float) +
                              data.normal.size() * sizeof(OctNormal) +
                              data.triangle.size() * sizeof(std::uint32_t) +
                              data.node.size() * sizeof(SurfaceNode) + (input.forest ? bytes_of(forest) : 0);
    baked.bytes_per_triangle = static_cast<double>(bytes) / static_cast<double>(baked.triangles);
    char line[200];
    std::snprintf(line, sizeof line, "surface: %zu vertices, %zu triangles, %s, %.1f bytes per triangle\n",
                  baked.vertices, baked.triangles, baked.closed ? "closed" : "open",
                  baked.bytes_per_triangle);
    baked.note += line;
    const auto say_shape = [&](const std::optional<ForestShape>& shape, const char* how) {
        if (!shape) return;
        std::snprintf(line, sizeof line,
                      "forest%s: %u trees, depth %u; reach / sqrt(area below): mean %.2f, 99th percentile "
                      "%.2f\n",
                      how, shape->trees, shape->depth, shape->mean, shape->p99);
        baked.note += line;
    };
    say_shape(baked.shape, "");
    say_shape(baked.shape_without_locality, " without locality");
    std::snprintf(line, sizeof line,
                  "hand: 1 mm is %.6g m of the model; the diagonal of the mesh is %.0f mm\n",
                  1e-3 / baked.meta.world_per_model, 1e3 * input.size_m);
    baked.note += line;
    if (input.tool.triangles() > 0) bake_tool(input, out, baked, part(progress, 0.7, 0.72));
    write_meta(out, baked.meta, baked.note);
    write_surface(out, data);
    if (input.forest) write_forest(out, forest);
    if (!input.picture) return baked;
    TriangleMesh drawn = std::move(input.mesh);
    double from = 0.72;
    if (input.vertices_max > 0 && drawn.vertices() > input.vertices_max) {
        SimplifySettings settings;
        settings.vertices_min = input.vertices_max;
        drawn = simplify(drawn, settings, part(progress, from, 0.85)).mesh;
        from = 0.85;
    }
    const ProgressiveMeshData picture = make_progressive(drawn, {}, part(progress, from, 1.0));
    baked.display_vertices = static_cast<std::uint32_t>(picture.vertex.size());
    write_mesh(out, 0, picture);
    return baked;
}

}  // namespace tact
