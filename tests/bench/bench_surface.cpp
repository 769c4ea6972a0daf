#include "tests/bench/bench_surface.hpp"

#include <algorithm>
#include <array>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "tests/bench/positions.hpp"
#include "tests/bench/put_percentiles.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/bench/touch_run.hpp"
#include "tests/bench/touch_tool_run.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr std::size_t kSlideSamples = 4000;
constexpr int kPasses = 3;  // also part of the key names

SurfaceSettings model_settings(double radius_m, bool shading) {
    return {.radius_m = radius_m,
            .stiffness_n_m = 500.0,
            .damping_n_s_m = 0.0,
            .friction = 0.0,
            .shading = shading,
            .force_n_max = 100.0};
}

}  // namespace

json bench_surface() {
    json all;
    std::uint64_t jammed = 0, unsettled = 0;
    const TouchTool block = bake_tool_to_measure("block"), scaler = bake_tool_to_measure("scaler");
    for (const auto& sphere : {std::pair<std::string, int>{"92k", 68}, {"2m", 316}, {"10m", 707}}) {
        const std::string& key = sphere.first;  // Clang 14 cannot capture structured bindings
        const ScratchFolder scratch;
        const auto scene = scratch.path() / "surface.tact";
        std::vector<std::string> arguments{"demo",   "touch",   "--shape",
                                           "sphere", "--parts", std::to_string(sphere.second)};
        // Building the forest of the largest mesh would take longer than all measurements. The memory per triangle is
        // that of the other meshes.
        const bool largest = key == "10m";
        if (largest) arguments.emplace_back("--no-forest");
        const json baked = bake_to_measure(arguments, scene);
        all["build_s_" + key] = baked.value("build_s", 0.0);
        if (!largest) all["bytes_per_triangle"] = baked.value("bytes_per_triangle", 0.0);
        const SceneFile file = SceneFile::open(scene);
        const SurfaceMesh surface = read_surface(file);
        const std::vector<Vec3> path = touch_path_m(surface, TouchPath::slide, 1.0, kSlideSamples);
        const auto count = [&](const std::string& tool, const std::vector<TouchStep>& steps) {
            put_percentiles(all, tool + "_us", times_us(steps), "_" + key);
            put_percentiles(all, tool + "_us_best_of_3", best_times_us(steps), "_" + key);
            all[tool + "_jammed_" + key] = jammed_cycles(steps);
            jammed += jammed_cycles(steps);
            unsettled += unsettled_cycles(steps);
        };
        for (const auto& [tool, radius_m] :
             {std::pair<std::string, double>{"point", 0.0}, {"sphere1mm", 1e-3}, {"sphere3mm", 3e-3}})
            count(tool,
                  touch_along(surface, path, model_settings(radius_m, true), kPasses, 1.0, nullptr, true));
        for (const auto& [name, tool] :
             {std::pair<std::string, const TouchTool*>{"tool1000", &block}, {"scaler1000", &scaler}})
            count(name, touch_tool_along(surface, *tool, tool_path(path, *tool), model_settings(0.0, true),
                                         kPasses, nullptr, true));
    }
    all["jammed_cycles"] = jammed;
    all["unsettled_cycles"] = unsettled;
    return all;
}

std::string surface_work_csv(const SurfaceWork& work) {
    const ScratchFolder scratch;
    const auto scene = scratch.path() / "surface.tact";
    static_cast<void>(bake_to_measure(
        {"touch", std::filesystem::absolute(work.mesh).string(), "--unit", work.unit}, scene));
    const std::array<std::pair<const char*, double>, 6> units{
        {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}, {"a", 1e-10}}};
    const auto unit =
        std::find_if(units.begin(), units.end(), [&](const auto& u) { return work.unit == u.first; });
    if (unit == units.end())
        throw StartupError("measure contact with " + work.mesh.string(), work.unit + " is not a unit",
                           "use m, cm, mm, um, nm or a");
    const std::vector<Vec3> path = read_positions(work.trajectory, unit->second);
    const SceneFile file = SceneFile::open(scene);
    const SurfaceMesh surface = read_surface(file);
    const std::vector<TouchStep> steps =
        touch_along(surface, path, model_settings(1e-3 * work.radius_mm, false), kPasses, 1.0, nullptr, true);
    std::string text = "t_s,force_x_n,force_y_n,force_z_n,us,settled,best_of_3_us\n";
    char row[200];
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const TouchStep& s = steps[i];
        std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f,%.6f,%.3f,%d,%.3f\n",
                      kTouchStepS * static_cast<double>(i), s.force_n.x(), s.force_n.y(), s.force_n.z(), s.us,
                      s.settled ? 1 : 0, s.best_us);
        text += row;
    }
    return text;
}

}  // namespace tact::launch
