// Points of the ball: a low-discrepancy sequence in three dimensions (Roberts' generalization of the golden ratio, with
// steps that are powers of 1 / 1.22074...), mapped to the ball with uniform density. Each point has its mirror image, so
// every odd moment is zero and any level averages a field that is linear across the ball exactly.
#include "rt/force/field/field_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ipc/base/random.hpp"

namespace tact {
namespace {

constexpr int kErrorPlaces = 512;
constexpr double kErrorMargin = 1.25;
constexpr double kReachM = 10.0;   // positions farther away are invalid
constexpr double kOnLevel = 1e-5;  // tolerance of being on a level, as a fraction of a level's distance
// ns, 2026-11-25, AVX-512 at 3.7 GHz.
constexpr double kFieldStepNs = 100.0, kFieldPointNs = 8.0;

}  // namespace

FieldModel::FieldModel(const SceneMeta& meta, const FieldMeta& field, const DensityGrid& grid)
    : meta_(meta), field_(field), map_(grid, field.mean, field.deviation) {
    if (field.probe_radius_m > 0.0)
        for (const std::uint32_t points : kPoints) levels_.push_back(ball(points, field.probe_radius_m));
    else
        levels_.push_back(ball(1, 0.0));
    measure_errors();
}

FieldModel::Level FieldModel::ball(std::uint32_t points, double radius_m) {
    constexpr double kRatio = 1.0 / 1.22074408460575947536;
    Level level;
    for (std::uint32_t i = 0; i < std::max(points / 2, 1U); ++i) {
        const auto part = [&](double step) {
            const double v = 0.5 + step * (i + 1.0);
            return v - std::floor(v);
        };
        const double r_m = radius_m * std::cbrt(part(kRatio)), c = 2.0 * part(kRatio * kRatio) - 1.0,
                     angle = 2.0 * std::numbers::pi * part(kRatio * kRatio * kRatio),
                     s = std::sqrt(1.0 - c * c);
        const Vec3 p = r_m * Vec3(s * std::cos(angle), s * std::sin(angle), c);
        for (const double side : {1.0, -1.0}) {
            if (points == 1 && side < 0.0) continue;
            level.x.push_back(static_cast<float>(side * p.x()));
            level.y.push_back(static_cast<float>(side * p.y()));
            level.z.push_back(static_cast<float>(side * p.z()));
        }
    }
    level.weight.assign(level.x.size(), 1.0F / static_cast<float>(level.x.size()));
    return level;
}

void FieldModel::measure_errors() {
    if (levels_.size() == 1) return;
    const Level reference = ball(2 * kPoints.back(), field_.probe_radius_m);
    SeededRandom random(1);
    for (int i = 0; i < kErrorPlaces; ++i) {
        Vec3 at;
        for (Eigen::Index a = 0; a < 3; ++a)
            at[a] = field_.box_low_m[a] + random.uniform() * (field_.box_high_m[a] - field_.box_low_m[a]);
        const Vec3 wanted = force_n(reference, at);
        for (Level& level : levels_)
            level.error_n = std::max(level.error_n, kErrorMargin * (force_n(level, at) - wanted).norm());
    }
    for (std::size_t l = levels_.size() - 1; l-- > 0;)
        levels_[l].error_n = std::max(levels_[l].error_n, levels_[l + 1].error_n);
}

KnobSpec FieldModel::knob() const noexcept {
    return {.path = "field.force", .floor = 0.0F, .start = 1.0F, .slew_per_s = 4.0F, .haptic = true};
}

FieldModel::Plan FieldModel::plan(float fidelity) const noexcept {
    const double f = fidelity > 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    const std::size_t last = levels_.size() - 1;
    double place = f * static_cast<double>(last);
    if (std::abs(place - std::round(place)) < kOnLevel) place = std::round(place);
    const auto lower = std::min(static_cast<std::size_t>(place), last);
    const double blend = place - static_cast<double>(lower);
    return {lower, blend > 0.0 ? lower + 1 : lower, blend};
}

std::uint32_t FieldModel::items(float fidelity) const noexcept {
    return static_cast<std::uint32_t>(levels_[plan(fidelity).upper].x.size());
}

PathLoad FieldModel::predict(float fidelity) const noexcept {
    const Plan p = plan(fidelity);
    PathLoad load;
    load.items = static_cast<std::uint32_t>(levels_[p.upper].x.size());
    load.cost_predicted = Duration(std::llround(kFieldStepNs + kFieldPointNs * load.items));
    load.error = (1.0 - p.blend) * levels_[p.lower].error_n + p.blend * levels_[p.upper].error_n;
    return load;
}

void FieldModel::reset(const ToolState& /*tool*/) noexcept { fade_.cut(); }

Vec3 FieldModel::force_n(const Level& level, const Vec3& at_model_m, std::size_t first) const noexcept {
    const auto rest = [first](const std::vector<float>& all) { return std::span(all).subspan(first); };
    const DensitySums sums = map_.sum({rest(level.x), rest(level.y), rest(level.z), rest(level.weight)},
                                      {at_model_m, Quat::Identity()});
    return (-field_.force_n_m_per_unit * field_.deviation) * sums.gradient;
}

// 1 inside the box, 0 beyond kFadeSteps outside of it.
double FieldModel::inside(const Vec3& at_model_m) const noexcept {
    double outside = 0.0;
    for (Eigen::Index a = 0; a < 3; ++a)
        outside = std::max({outside, (field_.box_low_m[a] - at_model_m[a]) / map_.spacing_m()[a],
                            (at_model_m[a] - field_.box_high_m[a]) / map_.spacing_m()[a]});
    const double s = std::clamp(1.0 - outside / kFadeSteps, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

StepResult FieldModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Instant begin = Monotonic::now();
    StepResult result;
    fade_.begin_step(step_s());
    if (!tool.T_world_tool.finite() || tool.T_world_tool.p_m.cwiseAbs().maxCoeff() > kReachM ||
        tool.T_world_tool.q.norm() < 0.5) {
        fade_.cut();
        result.status = StepStatus::out_of_range;
        result.load.error = levels_.front().error_n;
        return result;
    }
    if ((tool.buttons & 1U) != 0)
        fade_.fall();
    else
        fade_.rise();
    const Vec3 at_m = meta_.to_model(tool.T_world_tool.p_m);
    const double gain = fade_.gain() * inside(at_m);
    Plan p = plan(budget.fidelity);
    // The floor is always summed: 8 points take well under a microsecond.
    if (budget.deadline.passed()) {
        result.status = StepStatus::out_of_time;
        p = {0, 0, 0.0};
    }
    const Level &lower = levels_[p.lower], &upper = levels_[p.upper];
    Vec3 force = force_n(lower, at_m);
    result.load.error = lower.error_n;
    if (p.upper != p.lower) {
        // The lower level's points are the first of the upper one's.
        const std::size_t first = lower.x.size();
        const double part = static_cast<double>(first) / static_cast<double>(upper.x.size());
        const Vec3 finer = part * force + force_n(upper, at_m, first);
        force = (1.0 - p.blend) * force + p.blend * finer;
        result.load.error = (1.0 - p.blend) * lower.error_n + p.blend * upper.error_n;
    }
    const PathLoad planned = predict(budget.fidelity);
    result.load.cost_predicted = planned.cost_predicted;
    result.load.items = static_cast<std::uint32_t>(upper.x.size());
    if (result.status == StepStatus::out_of_time)
        result.load.work_done = static_cast<float>(result.load.items) / static_cast<float>(planned.items);
    if (result.status == StepStatus::ok && budget.deadline.passed()) result.status = StepStatus::out_of_time;
    result.wrench_world = fade_.show({gain * force, Vec3::Zero()});
    result.load.cost = Monotonic::now() - begin;
    return result;
}

ModelBodies FieldModel::bodies() const noexcept {
    ModelBodies none;
    none.active = ModelBodies::kNone;
    return none;
}

std::unique_ptr<ForceModel> load_field_model(const SceneFile& scene) {
    return std::make_unique<FieldModel>(read_meta(scene), read_field_meta(scene), read_grid(scene));
}

}  // namespace tact
