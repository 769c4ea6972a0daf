#include "deploy/tact/bench_surface.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/assets/surface_mesh.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "rt/force/surface/surface_model.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr double kStepS = 1e-3, kStiffness = 500.0;
constexpr std::size_t kSlideSamples = 4000;
constexpr int kPasses = 3;
constexpr std::uint64_t kJammedRow = 5;
constexpr std::size_t kPathMax = 10'000'000;

struct Step {
    Vec3 force_n = Vec3::Zero();
    double us = 1e300;
    bool settled = true, stands = false;
};

// Baked by tact-prep with the given words before -o, without a picture; what it said as JSON.
json bake_to_measure(const std::vector<std::string>& words, const std::filesystem::path& scene) {
    const auto log = scene.parent_path() / "bake.json";
    const int fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    ChildSettings settings;
    settings.arguments = words;
    settings.arguments.insert(settings.arguments.end(), {"--no-picture", "--json", "-o", scene.string()});
    settings.output_fd = fd;
    Child child("tact-prep", find_program("tact-prep"), settings);
    if (fd >= 0) ::close(fd);
    const auto& ending = child.wait(std::chrono::minutes(10));
    const std::string said = read_small(log);  // its progress, then the numbers
    json numbers = json::parse(said.substr(std::min(said.find('{'), said.size())), nullptr, false);
    if (!ending || !ending->clean() || !numbers.is_object())
        throw StartupError("bake a surface to measure",
                           "tact-prep " + (ending ? ending->text() : "did not end in ten minutes"),
                           "see what it said above");
    return numbers;
}

std::vector<Step> follow(const SurfaceMesh& surface, const std::vector<Vec3>& path_m, double radius_m,
                         bool shading, int passes) {
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = 1.0;  // the model is as large as in its file
    std::vector<Step> steps(path_m.size());
    for (int pass = 0; pass < passes; ++pass) {
        SurfaceModel model(meta, surface,
                           {.radius_m = radius_m,
                            .stiffness_n_m = kStiffness,
                            .damping_n_s_m = 0.0,
                            .friction = 0.0,
                            .shading = shading,
                            .force_n_max = 100.0});
        ToolState tool;
        if (!path_m.empty()) tool.T_world_tool.p_m = path_m.front();
        model.reset(tool);
        // The force has faded in when the path begins.
        for (int i = 0; i < ForceFade::kRampSteps; ++i) (void)model.step(tool, {});
        Vec3 before_m = model.contact().proxy_m;
        for (std::size_t i = 0; i < path_m.size(); ++i) {
            tool.T_world_tool.p_m = path_m[i];
            const Instant begin = Monotonic::now();
            const StepResult result = model.step(tool, {});
            const double us = to_us(Monotonic::now() - begin);
            const Vec3 now_m = model.contact().proxy_m;
            const bool settled = model.contact().state == ContactState::settled;
            const bool nearer = (now_m - path_m[i]).norm() < (before_m - path_m[i]).norm() - 1e-7;
            steps[i] = {result.wrench_world.force_n, std::min(us, steps[i].us), settled, !settled && !nearer};
            before_m = now_m;
        }
    }
    return steps;
}

// How far the surface is from the origin in a direction, seen from outside: steps by the clearance.
double radius_of_surface(const SurfaceMesh& surface, const Vec3& direction, double from_m) {
    double r = from_m;
    for (int i = 0; i < 400 && r > 0.0; ++i) {
        const double free_m = surface.nearest(r * direction, 1.0).distance_m;
        if (free_m < 1e-6) break;
        r -= 0.9 * free_m;
    }
    return r;
}

std::vector<Vec3> slide_m(const SurfaceMesh& surface) {
    std::vector<Vec3> path;
    const double outside_m = 1.01 * std::max(surface.low_m().norm(), surface.high_m().norm());
    for (std::size_t i = 0; i < kSlideSamples; ++i) {
        const double t = kStepS * static_cast<double>(i);
        const double around = 1.1 * t + 0.3 * std::sin(0.7 * t),
                     up = 0.9 * std::sin(0.61 * t) + 0.2 * std::sin(3.1 * t);
        const Vec3 direction(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
        const double in = std::min(1.0, t / 0.25);  // from 3 mm outside
        const double depth = 1.5e-3 + 5e-4 * std::sin(8.2 * t);
        path.push_back((radius_of_surface(surface, direction, outside_m) + 3e-3 * (1.0 - in) - depth * in) *
                       direction);
    }
    return path;
}

double percentile(const std::vector<Step>& steps, double share) {
    std::vector<double> us;
    for (const Step& s : steps) us.push_back(s.us);
    std::sort(us.begin(), us.end());
    return us.empty() ? 0.0
                      : us[std::min(us.size() - 1,
                                    static_cast<std::size_t>(share * static_cast<double>(us.size())))];
}

}  // namespace

json bench_surface() {
    json all;
    std::uint64_t jammed = 0, unsettled = 0;
    for (const auto& [key, parts] : {std::pair<std::string, int>{"92k", 68}, {"2m", 316}, {"10m", 707}}) {
        const ScratchFolder scratch;
        const auto scene = scratch.path() / "surface.tact";
        const json baked =
            bake_to_measure({"demo", "touch", "--shape", "sphere", "--parts", std::to_string(parts)}, scene);
        all["build_s_" + key] = baked.value("build_s", 0.0);
        all["bytes_per_triangle"] = baked.value("bytes_per_triangle", 0.0);
        const SceneFile file = SceneFile::open(scene);
        const SurfaceMesh surface = read_surface(file);
        const std::vector<Vec3> path = slide_m(surface);
        for (const auto& [tool, radius_m] :
             {std::pair<std::string, double>{"point", 0.0}, {"sphere1mm", 1e-3}, {"sphere3mm", 3e-3}}) {
            const std::vector<Step> steps = follow(surface, path, radius_m, true, kPasses);
            all[tool + "_us_p50_" + key] = percentile(steps, 0.5);
            all[tool + "_us_p99_" + key] = percentile(steps, 0.99);
            all[tool + "_us_p999_" + key] = percentile(steps, 0.999);
            all[tool + "_us_max_" + key] = percentile(steps, 1.0);
            std::uint64_t row = 0;
            for (const Step& s : steps) {
                row = s.stands ? row + 1 : 0;
                if (row >= kJammedRow) jammed += row == kJammedRow ? kJammedRow : 1;
                if (!s.settled) ++unsettled;
            }
        }
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
    const std::string attempt = "read the positions in " + work.trajectory.string();
    std::ifstream in(work.trajectory);
    if (!in || unit == units.end()) throw StartupError(attempt, "it cannot be read", "check the path");
    std::vector<Vec3> path;
    std::string line;
    while (std::getline(in, line)) {
        if (line.empty() || line.front() == '#') continue;
        Vec3 p;
        std::istringstream words(line);
        if (!(words >> p.x() >> p.y() >> p.z()) || !p.allFinite() || path.size() == kPathMax)
            throw StartupError(attempt, "line " + std::to_string(path.size() + 1) + " is no position",
                               "give x y z in the mesh's unit on each line, ten million at the most");
        path.push_back(unit->second * p);
    }
    const SceneFile file = SceneFile::open(scene);
    const SurfaceMesh surface = read_surface(file);
    const std::vector<Step> steps = follow(surface, path, 1e-3 * work.radius_mm, false, kPasses);
    std::string text = "t_s,force_x_n,force_y_n,force_z_n,us,settled\n";
    char row[200];
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Step& s = steps[i];
        std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f,%.6f,%.3f,%d\n", kStepS * static_cast<double>(i),
                      s.force_n.x(), s.force_n.y(), s.force_n.z(), s.us, s.settled ? 1 : 0);
        text += row;
    }
    return text;
}

}  // namespace tact::launch
