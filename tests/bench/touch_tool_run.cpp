#include "tests/bench/touch_tool_run.hpp"

#include <algorithm>

#include "deploy/tact/files.hpp"
#include "ipc/base/clock.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "tests/bench/loop_thread.hpp"

namespace tact::launch {
namespace {

constexpr double kTurnRadStep = 0.5e-3;

}  // namespace

TouchTool bake_tool_to_measure(const std::string& name) {
    const ScratchFolder scratch;
    const auto scene = scratch.path() / "tool.tact";
    // Only the tool of this scene is used.
    static_cast<void>(bake_to_measure(
        {"demo", "touch", "--shape", "sphere", "--parts", "4", "--tool", name, "--tool-points", "1000"},
        scene));
    return read_touch_tool(SceneFile::open(scene));
}

std::vector<Pose> tool_path(const std::vector<WanderPlace>& places, const TouchTool& tool) {
    double lowest_m = 0.0;
    for (std::size_t i = 0; i < tool.points(); ++i) lowest_m = std::min(lowest_m, tool.at_m(i).y());
    std::vector<Pose> path;
    path.reserve(places.size());
    for (const auto& [p, up] : places) {
        const Quat turned(Eigen::AngleAxisd(kTurnRadStep * static_cast<double>(path.size()), Vec3::UnitY()));
        path.push_back({p - lowest_m * up, Quat::FromTwoVectors(Vec3::UnitY(), up) * turned});
    }
    return path;
}

std::vector<Pose> tool_path(const std::vector<Vec3>& path_model_m, const TouchTool& tool) {
    std::vector<WanderPlace> places;
    for (const Vec3& p : path_model_m) places.push_back({p, p.normalized()});
    return tool_path(places, tool);
}

std::vector<TouchStep> touch_tool_along(const SurfaceMesh& surface, const TouchTool& tool,
                                        const std::vector<Pose>& path, const SurfaceSettings& settings,
                                        int passes, const VertexForest* forest, bool paced) {
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = 1.0;
    std::vector<TouchStep> steps(path.size());
    const auto run_pass = [&](int pass) {
        ToolModel model(meta, surface, tool, settings, forest);
        ToolState hand;
        hand.T_world_tool = path.front();
        model.reset(hand);
        for (int seated = 0; seated < ForceFade::ramp_steps(1e-3);
             seated += model.contact().seating() ? 0 : 1) {
            (void)model.step(hand, {});
            model.slow_update(hand, {});
        }
        LoopPace pace(paced && pass == 0 ? kTouchStepS : 0.0);
        for (std::size_t i = 0; i < path.size(); ++i) {
            hand.T_world_tool = path[i];
            if (i > 0) hand.twist_world.linear_m_s = (path[i].p_m - path[i - 1].p_m) / kTouchStepS;
            const double before_m = model.contact().way_m(path[i], model.contact().proxy()).norm();
            pace.wait();
            const Instant begin = Monotonic::now();
            const StepResult result = model.step(hand, {});
            const double us = to_us(Monotonic::now() - begin);
            const bool settled = model.tool_touch().state == ContactState::settled;
            const double left_m = model.contact().way_m(path[i], model.contact().proxy()).norm();
            steps[i] = {result.wrench_world.force_n, pass == 0 ? us : steps[i].us,
                        std::min(us, steps[i].best_us), settled, !settled && left_m > before_m - 1e-7};
            steps[i].adaptive = model.regime() == TouchRegime::adaptive;
            if (i % kSlowUpdateEvery == 0) model.slow_update(hand, {});
        }
    };
    for (int pass = 0; pass < passes && !path.empty(); ++pass) {
        if (paced && pass == 0)
            run_as_loop(kServoPriority, [&] { run_pass(0); });
        else
            run_pass(pass);
    }
    return steps;
}

}  // namespace tact::launch
