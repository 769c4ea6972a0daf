#include "tests/bench/touch_run.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "tests/bench/loop_thread.hpp"
#include "tests/bench/touch_paths.hpp"

namespace tact::launch {

using nlohmann::json;

json bake_to_measure(const std::vector<std::string>& arguments, const std::filesystem::path& scene) {
    const auto log = scene.parent_path() / "bake.json";
    const int fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    ChildSettings settings;
    settings.arguments = arguments;
    settings.arguments.insert(settings.arguments.end(), {"--no-picture", "--json", "-o", scene.string()});
    settings.output_fd = fd;
    Child child("tact-prep", find_program("tact-prep"), settings);
    if (fd >= 0) ::close(fd);
    const auto& ending = child.wait(std::chrono::minutes(10));
    const std::string output = read_small(log);  // progress, then JSON
    json numbers = json::parse(output.substr(std::min(output.find('{'), output.size())), nullptr, false);
    if (!ending || !ending->clean() || !numbers.is_object())
        throw StartupError(
            "bake a surface to measure",
            "tact-prep " + (ending ? ending->text() : "did not exit within ten minutes") + ": " + output,
            "run by hand: tact-prep " + arguments.front());
    return numbers;
}

std::vector<TouchStep> touch_along(const SurfaceMesh& surface, const std::vector<Vec3>& path_model_m,
                                   const SurfaceSettings& settings, int passes, double world_per_model,
                                   const VertexForest* forest, bool paced) {
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = world_per_model;
    std::vector<TouchStep> steps(path_model_m.size());
    const auto run_pass = [&](int pass) {
        SurfaceModel model(meta, surface, settings, forest);
        ToolState tool;
        tool.T_world_tool.p_m = world_per_model * path_model_m.front();
        model.reset(tool);
        for (int i = 0; i < ForceFade::ramp_steps(1e-3); ++i) {
            (void)model.step(tool, {});
            if (model.has_slow_update()) model.slow_update(tool, {});
        }
        Vec3 before_m = model.contact().proxy_m;
        LoopPace pace(paced && pass == 0 ? kTouchStepS : 0.0);
        for (std::size_t i = 0; i < path_model_m.size(); ++i) {
            tool.T_world_tool.p_m = world_per_model * path_model_m[i];
            if (i > 0)
                tool.twist_world.linear_m_s =
                    world_per_model / kTouchStepS * (path_model_m[i] - path_model_m[i - 1]);
            pace.wait();
            const Instant begin = Monotonic::now();
            const StepResult result = model.step(tool, {});
            const double us = to_us(Monotonic::now() - begin);
            const Vec3 now_m = model.contact().proxy_m;
            const bool settled = model.contact().state == ContactState::settled;
            const bool nearer = (now_m - path_model_m[i]).norm() <
                                (before_m - path_model_m[i]).norm() - 1e-7 / world_per_model;
            steps[i] = {result.wrench_world.force_n, pass == 0 ? us : steps[i].us,
                        std::min(us, steps[i].best_us), settled, !settled && !nearer};
            steps[i].adaptive = model.regime() == TouchRegime::adaptive;
            before_m = now_m;
            if (model.has_slow_update() && i % kSlowUpdateEvery == 0) model.slow_update(tool, {});
        }
    };
    for (int pass = 0; pass < passes && !path_model_m.empty(); ++pass) {
        if (paced && pass == 0)
            run_as_loop(kServoPriority, [&] { run_pass(0); });
        else
            run_pass(pass);
    }
    return steps;
}

Percentiles times_us(const std::vector<TouchStep>& steps) {
    std::vector<double> us;
    for (const TouchStep& s : steps) us.push_back(s.us);
    return percentiles(us);
}

Percentiles best_times_us(const std::vector<TouchStep>& steps) {
    std::vector<double> us;
    for (const TouchStep& s : steps) us.push_back(s.best_us);
    return percentiles(us);
}

std::uint64_t jammed_cycles(const std::vector<TouchStep>& steps) {
    std::uint64_t series = 0, jammed = 0;
    for (const TouchStep& s : steps) {
        series = s.stands ? series + 1 : 0;
        if (series >= kJammedRow) jammed += series == kJammedRow ? kJammedRow : 1;
    }
    return jammed;
}

std::uint64_t unsettled_cycles(const std::vector<TouchStep>& steps) {
    return static_cast<std::uint64_t>(
        std::count_if(steps.begin(), steps.end(), [](const TouchStep& s) { return !s.settled; }));
}

}  // namespace tact::launch
