#include "rt/force/drilling/drill_rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

constexpr double kContactS = 0.5, kInS = 0.1, kInM_s = 0.1, kOutM_s = 0.03;
constexpr std::uint32_t kStepsMost = 2400, kFadeSteps = 40;
// Parts of a contact whose steps follow a pause each: where it cuts most, and where it touches most.
constexpr std::array<std::array<double, 2>, 2> kPausedS{{{0.06, 0.12}, {0.24, 0.3}}};

bool is_paused(double t_s) {
    return std::any_of(kPausedS.begin(), kPausedS.end(),
                       [t_s](const auto& part) { return t_s >= part[0] && t_s < part[1]; });
}

// Of a ball into a flat surface, by eq. 3.
double pressed_m(const DrillSettings& settings, double radius_m) {
    const double elastic_pa = settings.depth_at_1_n_m > 0.0 ? elastic_for(radius_m, settings.depth_at_1_n_m)
                                                            : settings.law.elastic_pa;
    return radius_m * std::cbrt(std::pow(DrillRehearsal::kPressN / (elastic_pa * radius_m * radius_m), 2.0));
}

struct Reach {
    double radius_m = 0.0, lowest_m = 0.0;  // largest ball; lowest point below the tool's origin
    double depth_m = 0.0;                   // of the trial
    explicit Reach(const DrillSettings& settings) {
        const DrillTool tool = make_drill_tool(settings.tool);
        for (std::uint32_t i = 0; i < tool.count; ++i) {
            radius_m = std::max(radius_m, tool.ball[i].radius_m);
            lowest_m = std::min(lowest_m, tool.ball[i].centre_tool_m.z() - tool.ball[i].radius_m);
        }
        depth_m = std::min(DrillRehearsal::kDeeper * pressed_m(settings, radius_m), radius_m);
    }
};

DrillRehearsal rehearse_in(const TrialBone& bone, const DrillSettings& settings, double step_s) {
    DrillRehearsal made;
    std::vector<TimedWork> samples;
    for (std::size_t i = 0; i < made.contact.size(); ++i) {
        // Levels above one that takes a period are as far out of reach.
        if (i > 0 && to_s(drill_cost(made.contact[i - 1])) > step_s) {
            made.contact[i] = made.contact[i - 1];
            continue;
        }
        made.contact[i] =
            first_contact(settings, bone, step_s, DrillRehearsal::kLevels[i],
                          DrillRehearsal::kMostS / static_cast<double>(made.contact.size()), samples);
    }
    made.set_speed(fit_speed(telling_steps(samples, step_s)));
    made.step_s = step_s;
    return made;
}

}  // namespace

DrillWork first_contact(const DrillSettings& settings, TrialBone trial, double step_s, float level,
                        double most_s, std::vector<TimedWork>& samples) {
    SceneMeta meta{};
    meta.world_per_model = 1.0;
    const Reach reach(settings);
    std::vector<std::uint32_t> revision(trial.bricks.brick_count(), 0);
    DrillBone bone(trial.bricks, trial.density, revision);
    DrillModel model(meta, bone, settings);
    ToolState hand;
    hand.T_world_tool.p_m.z() = -reach.lowest_m;
    model.reset(hand);
    const Budget budget{.fidelity = level};
    for (std::uint32_t i = 0; i < kFadeSteps; ++i) {
        model.drive({.enabled = true, .on = true, .step_s = ForceFade::kStepMostS});
        static_cast<void>(model.step(hand, budget));
    }
    const auto steps = static_cast<std::uint32_t>(std::clamp(kContactS / step_s, 1.0, double{kStepsMost}));
    const Instant end = Monotonic::now() + Duration(std::llround(1e9 * most_s));
    DrillWork most;
    Duration most_cost{0};
    for (std::uint32_t i = 0; i < steps && Monotonic::now() < end; ++i) {
        model.drive({.enabled = true, .on = true, .step_s = step_s});
        const bool paused = is_paused(i * step_s);
        if (paused) std::this_thread::sleep_for(Duration(std::llround(1e9 * step_s)));
        const StepResult result = model.step(hand, budget);
        // The first after a time without pauses is still as quick as those.
        if (paused && is_paused((i - 1.0) * step_s))
            samples.push_back({model.work(), 1e9 * to_s(result.load.cost)});
        const DrillWork next = model.expected(level, step_s);
        if (const Duration cost = drill_cost(next); cost > most_cost) {
            most_cost = cost;
            most = next;
        }
        double& z_m = hand.T_world_tool.p_m.z();
        if (i * step_s < kInS)
            z_m = std::max(z_m - kInM_s * step_s, -reach.lowest_m - reach.depth_m);
        else if (result.wrench_world.force_n.z() > DrillRehearsal::kLightN)
            z_m += kOutM_s * step_s;
    }
    return most;
}

void DrillRehearsal::set_speed(const DrillSpeed& speed) {
    speed_ = speed;
    for (std::size_t i = 0; i < contact.size(); ++i)
        log_ns_[i] = std::log(static_cast<double>(drill_cost(contact[i], speed).count()));
}

Duration DrillRehearsal::contact_cost(float level) const noexcept {
    if (!(step_s > 0.0)) return Duration{0};
    std::size_t above = 1;
    while (above + 1 < kLevels.size() && level > kLevels[above]) ++above;
    const double part = std::clamp(
        static_cast<double>((level - kLevels[above - 1]) / (kLevels[above] - kLevels[above - 1])), 0.0, 1.0);
    return Duration(std::llround(std::exp(std::lerp(log_ns_[above - 1], log_ns_[above], part))));
}

DrillRehearsal rehearse_drill(const DrillSettings& settings, double voxel_m, double step_s) {
    return rehearse_in(solid_bone(Reach(settings).radius_m, voxel_m), settings, step_s);
}

DrillRehearsal rehearse_drill(const DrillSettings& settings, const BoneBricks& bricks,
                              std::span<const std::uint8_t> density, double voxel_m, double step_s) {
    const Reach reach(settings);
    return rehearse_in(bone_of(bricks, density, reach.radius_m, reach.depth_m, voxel_m), settings, step_s);
}

}  // namespace tact
