#include "rt/servo/fit_level.hpp"

#include <algorithm>
#include <array>

namespace tact::servo {

namespace {

constexpr std::uint32_t kContinuousRows = 20;
constexpr float kLevelMaxLeast = 0.05F, kLevelMaxRise = 1.1F;

LevelFit::Limits limits_of(const CycleState& c, const ServoSettings& settings) noexcept {
    const double goal_s = 1.0 / c.governor.settings().goal_hz;
    return {.period_s = settings.free_running ? goal_s : std::min(to_s(settings.period), goal_s),
            .deadline_s = settings.model_deadline ? to_s(settings.model_max) : 1e9,
            .free_running = settings.free_running,
            // A loop of fixed rate has the whole period; the load of other programs appears as lateness.
            .budget =
                settings.free_running ? static_cast<double>(c.governor.paths()[kForcePathIndex].budget) : 1.0,
            .level_max = c.govern.level_max};
}

LevelFit::Sample sample_of(const CycleState& c) noexcept {
    double work_done = 1.0;
    for (std::uint32_t i = 0; i < c.hands; ++i)
        work_done = std::min(work_done, static_cast<double>(c.hand[i].step.load.work_done));
    return {.level = c.budget.fidelity,
            .model_s = to_s(c.model_cost),
            .predicted_s = to_s(c.hand[0].step.load.cost_predicted),
            .work_done = work_done,
            .recomputed = c.recomputed_fraction,
            .rest_s = c.govern.other_s,
            .dt_s = to_s(c.dt),
            .deadline_missed = c.deadline_missed};
}

void renew_rows(CycleState& c) noexcept {
    LevelFit& fit = c.govern.fit;
    const std::size_t rows = fit.rows().size();
    const auto renew = [&](std::size_t row) {
        const PathLoad load = c.hand[0].model->predict(fit.rows()[row].level);
        return fit.renew(row, to_s(load.cost_predicted), load.error, to_s(load.cost_foreseen));
    };
    if (rows == 0) return;
    fit.pass(to_s(c.dt));
    if (renew(fit.row())) {
        for (std::size_t i = 0; i < rows; ++i) static_cast<void>(renew(i));
    } else {
        static_cast<void>(renew(fit.due()));
    }
}

}  // namespace

void make_level_rows(CycleState& c) noexcept {
    const ForceModel& model = *c.hand[0].model;
    const KnobSpec knob = model.knob();
    const std::uint32_t steps =
        knob.steps > 0 ? std::min<std::uint32_t>(knob.steps, LevelFit::kRowsMax - 1) : kContinuousRows;
    std::array<LevelFit::Row, LevelFit::kRowsMax> rows{};
    std::size_t count = 0;
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(steps);
        const float level = knob.steps > 0 ? part : knob.floor + (1.0F - knob.floor) * part;
        const bool top = i == steps;
        if (!top && level < std::max(knob.floor, static_cast<float>(c.governor.settings().force_level_min)))
            continue;
        const PathLoad load = model.predict(level);
        rows[count++] = {.level = level,
                         .cost_s = to_s(std::max(load.cost_predicted, load.cost_foreseen)),
                         .error = load.error};
    }
    c.govern.fit.set_rows({rows.data(), count});
    c.govern.level_max = 1.0F;
    if (float first = 0.0F; c.govern.fit.calibrating(first))
        static_cast<void>(c.governor.set_fitted_level(kForcePathIndex, first, LevelReason::start));
}

void calibrate_level(CycleState& c, const ServoSettings& settings) noexcept {
    if (c.governor.settings().law == Law::fixed) return;
    LevelFit& fit = c.govern.fit;
    float level = 0.0F;
    if (fit.calibrating(level)) {
        fit.calibrate(to_s(c.model_cost), c.govern.other_s);
    } else {
        static_cast<void>(fit.learn(sample_of(c)));
    }
    if (fit.calibrating(level)) {
        static_cast<void>(c.governor.set_fitted_level(kForcePathIndex, level, LevelReason::start));
    } else {
        choose_level(c, settings);
    }
}

void choose_level(CycleState& c, const ServoSettings& settings) noexcept {
    if (c.govern.fit.rows().empty()) return;
    static_cast<void>(c.governor.set_fitted_level(
        kForcePathIndex, c.govern.fit.choose(limits_of(c, settings)), LevelReason::start));
}

bool fit_level(CycleState& c, const ServoSettings& settings) noexcept {
    renew_rows(c);
    if (c.governor.settings().law == Law::fixed) {
        static_cast<void>(c.govern.fit.learn(sample_of(c)));
        return false;
    }
    const LevelFit::Choice choice = c.govern.fit.add(sample_of(c), limits_of(c, settings));
    const GovernedPath& path = c.governor.paths()[kForcePathIndex];
    float level = choice.level;
    // A continuous knob rises at its slew rate; a model with discrete steps blends them itself.
    if (path.knob.steps == 0)
        level = std::min(level, path.level + path.knob.slew_per_s * static_cast<float>(to_s(c.dt)));
    const bool moved =
        c.governor.set_fitted_level(kForcePathIndex, level, choice.changed ? choice.reason : path.reason);
    return choice.changed || (moved && level == choice.level);
}

void limit_by_slow_update(CycleState& c) noexcept {
    const double slow_update_s = c.hand[0].model->slow_update_s();
    const auto load = static_cast<float>(slow_update_s / (kSlowUpdateFraction * to_s(kSlowUpdatePeriod)));
    float& most = c.govern.level_max;
    if (load > 1.0F && !c.governor.visual_can_give())
        most = std::max(c.governor.level(kForcePathIndex) / load, kLevelMaxLeast);
    else if (load < 1.0F)
        most = std::min(most * kLevelMaxRise, 1.0F);
}

}  // namespace tact::servo
