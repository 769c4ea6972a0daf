#include "deploy/tact/docking/eval.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "deploy/tact/docking/poses_csv.hpp"
#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact::launch {
namespace {

const char* name_of(StepStatus status) {
    switch (status) {
        case StepStatus::ok:
            return "ok";
        case StepStatus::out_of_time:
            return "out_of_time";
        case StepStatus::out_of_range:
            return "out_of_range";
    }
    return "unknown";
}

}  // namespace

EvalSummary run_eval(const EvalRequest& request) {
    const auto refuse = [&](const std::string& why, const std::string& fix) {
        throw StartupError("evaluating '" + request.scene.string() + "'", why, fix);
    };
    const double fidelity = request.fidelity;
    if (!(fidelity >= 0.0 && fidelity <= 1.0))
        refuse("the fidelity is outside 0 to 1",
               "give a --fidelity from 0 (smallest codebook) to 1 (all atoms)");
    const std::vector<TimedPose> poses = read_poses_csv(request.poses_csv);
    std::unique_ptr<ForceModel> loaded =
        load_docking_model(SceneFile::open(request.scene), DockingSettings{});
    ModelOrder select;
    select.body = request.body;
    if (!loaded->order(select))
        refuse("it has no body " + std::to_string(request.body),
               "give a --body from 1 to " + std::to_string(loaded->bodies().count));
    if (request.options != 0) {
        if (!dynamic_cast<DockingModel&>(*loaded).set_options(request.options, true))
            refuse("the options are unknown", "report this message");
        std::unique_ptr<ForceModel> next = loaded->rebuild(loaded->bodies());
        static_cast<void>(next->adopt(*loaded));
        loaded = std::move(next);
    }
    const auto* const model = dynamic_cast<const DockingModel*>(loaded.get());
    Budget budget;
    budget.fidelity = static_cast<float>(fidelity);
    EvalSummary summary;
    std::vector<double> costs_us;
    costs_us.reserve(poses.size());
    std::string text = "t_s,fx_n,fy_n,fz_n,tx_n_m,ty_n_m,tz_n_m,cost_us,error_n,points,status\n";
    text.reserve(text.size() + 160 * poses.size());
    char line[320];
    for (const TimedPose& pose : poses) {
        const Pose T_model_body{model->meta().to_model(pose.T_world_tool.p_m), pose.T_world_tool.q};
        const StepResult r = model->evaluate(T_model_body, budget);
        const Vec3 &f = r.wrench_world.force_n, &q = r.wrench_world.torque_n_m;
        std::snprintf(line, sizeof line, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.3f,%.6g,%u,%s\n", pose.t_s,
                      f.x(), f.y(), f.z(), q.x(), q.y(), q.z(), to_us(r.load.cost), r.load.error,
                      r.load.items, name_of(r.status));
        text += line;
        costs_us.push_back(to_us(r.load.cost));
        summary.force_n_max = std::max(summary.force_n_max, f.norm());
        if (r.status != StepStatus::ok) ++summary.not_ok;
    }
    summary.poses = poses.size();
    std::sort(costs_us.begin(), costs_us.end());
    summary.cost_us_p50 = costs_us[costs_us.size() / 2];
    summary.cost_us_max = costs_us.back();
    write_whole(request.out_csv, text);
    return summary;
}

}  // namespace tact::launch
