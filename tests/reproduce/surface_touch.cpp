#include "tests/reproduce/surface_touch.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>

#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/bench/touch_tool_run.hpp"

namespace tact::launch {
namespace {

struct Hand {
    const char* name;
    double speed_m_s;
};
constexpr Hand kHands[] = {{kSlowHand, 0.055}, {"fast", 0.22}};
constexpr int kPasses = 3;
constexpr std::size_t kBruteMost = 600'000;  // triangles; beyond, a step takes tens of milliseconds or more

// Number of steps of off-brute that take some seconds. Each step queries all triangles.
std::size_t brute_steps(std::size_t triangles, std::size_t most) {
    return std::clamp<std::size_t>(100'000'000 / std::max<std::size_t>(triangles, 1), 10, most);
}

// For the mesh tool the model has its true size; for balls the path is scaled.
constexpr const char* kMeshTool = "block";
constexpr std::size_t kToolBruteMost = 100'000, kToolBruteQueries = 50;

struct TouchRequest {
    SurfaceSettings settings;
    std::size_t steps;
    int passes;
};
using RunTouch = std::function<std::vector<TouchStep>(const TouchRequest&)>;

// Runs one tool in all modes. queries: queries per triangle in a step of off-brute, which is skipped beyond brute_most
// triangles.
void in_all_modes(std::vector<TouchRow>& rows, const TouchRow& about, const TouchRequest& whole,
                  std::size_t brute_most, std::size_t queries, const RunTouch& run_touch) {
    std::vector<TouchStep> by_tree;
    for (const SurfaceMode mode : {SurfaceMode::off_tree, SurfaceMode::off_brute, SurfaceMode::chr}) {
        TouchRequest request = whole;
        request.settings.mode = mode;
        if (mode == SurfaceMode::off_brute) {
            if (about.triangles > brute_most) continue;
            request.steps = brute_steps(queries * about.triangles, whole.steps);
            request.passes = 1;
        }
        const std::vector<TouchStep> steps = run_touch(request);
        TouchRow row = row_of(steps);
        if (mode == SurfaceMode::off_tree)
            by_tree = steps;
        else
            compare(row, steps, by_tree);
        row.mesh = about.mesh;
        row.triangles = about.triangles;
        row.tool = about.tool;
        row.hand = about.hand;
        row.mode = kSurfaceModeNames[static_cast<std::size_t>(mode)];
        rows.push_back(row);
        std::printf("  %-24s %9zu  %-11s %-5s %-9s %8.0f Hz, %s\n", row.mesh.c_str(), row.triangles,
                    row.tool.c_str(), row.hand.c_str(), row.mode.c_str(), row.rate_hz, quality(row).c_str());
        std::fflush(stdout);
    }
}

}  // namespace

SurfaceSettings settings_to_measure(double radius_m) {
    return {.radius_m = radius_m,
            .stiffness_n_m = 500.0,
            .damping_n_s_m = 0.0,
            .friction = 0.2,
            .shading = true,
            .force_n_max = 100.0};
}

std::vector<TouchRow> touch_in_all_modes(const std::string& name, const std::filesystem::path& scene,
                                         bool quick) {
    const SceneFile file = SceneFile::open(scene);
    const SurfaceMesh surface = read_surface(file);
    const VertexForest forest = read_forest(file, surface.all_positions_m(), surface.all_corners());
    const double world_per_model = read_meta(file).world_per_model;
    const TouchTool points = bake_tool_to_measure(kMeshTool);
    const std::size_t steps = quick ? 2000 : 20000;
    std::vector<TouchRow> rows;
    TouchRow about;
    about.mesh = name;
    about.triangles = surface.triangles();
    for (const Hand& hand : kHands) {
        about.hand = hand.name;
        const std::vector<Vec3> path = wander_m(
            surface,
            {hand.speed_m_s / world_per_model, 1.5e-3 / world_per_model, 7, 1.5e-3 / world_per_model}, steps);
        for (const TouchBall& tool : kTouchBalls) {
            about.tool = tool.name;
            in_all_modes(rows, about, {settings_to_measure(tool.radius_m), steps, quick ? 1 : kPasses},
                         kBruteMost, 1, [&](const TouchRequest& a) {
                             return touch_along(
                                 surface, {path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a.steps)},
                                 a.settings, a.passes, world_per_model, &forest);
                         });
        }
        about.tool = "1000 points";
        const std::vector<Pose> tool_poses = tool_path(
            wander(surface, {.speed_m_s = hand.speed_m_s, .seed = 7, .even_m = 1e-2}, steps), points);
        in_all_modes(rows, about, {settings_to_measure(0.0), steps, quick ? 1 : kPasses}, kToolBruteMost,
                     kToolBruteQueries, [&](const TouchRequest& a) {
                         return touch_tool_along(
                             surface, points,
                             {tool_poses.begin(), tool_poses.begin() + static_cast<std::ptrdiff_t>(a.steps)},
                             a.settings, a.passes, &forest);
                     });
    }
    return rows;
}

}  // namespace tact::launch
