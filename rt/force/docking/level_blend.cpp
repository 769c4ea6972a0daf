// Derivation. A body has points x_i = c + q b_i with weights w_i, sum w_i = 1, and b_i relative to its centre
// of mass c. With U = -k_E sum w_i rho(x_i), a displacement dc and a small rotation dphi (model axes) give
//     dU = -k_E sum w_i grad rho(x_i) . (dc + dphi x (x_i - c))
//        = -k_E [ (sum w_i grad rho) . dc + (sum w_i (x_i - c) x grad rho) . dphi ].
// The docking paper prints the torque as w_i x grad rho; the lever arm must be x_i - c. World axes are parallel
// to model axes and dx_world = S dx_model (S = world_per_model), so force and torque at the hand are
//     F_world = (k_E / S) sum w_i grad rho,    Q_world = k_E sum w_i (x_i - c) x grad rho,
// the derivatives of the same U by the tool's position and rotation: the hand gains no energy on a closed path.
// As the weights sum to one, neither depends on the number of points that represent the body.
//
// Between two levels the wrenches are blended linearly. A blend is the derivative of the blended energies:
// conservative at a constant knob, and continuous as the knob changes.
#include "rt/force/docking/level_blend.hpp"

#include <algorithm>
#include <cmath>

#include "rt/force/docking/docking_parts.hpp"

namespace tact {

namespace {

// A larger level is preceded by the sum of one of at most 1/kSafeShare of its size, as a fallback.
constexpr std::size_t kSafeShare = 16;
constexpr float kPartLeast = 0.01F;  // work of a late step that recomputed nothing
constexpr double kOnLevel = 1e-5;    // fraction of the distance between levels

}  // namespace

float LevelBlend::start_fidelity() const noexcept {
    std::size_t start = 0;
    while (start + 1 < levels.size() && levels[start].size() < 200) ++start;  // as in the docking paper
    return levels.size() > 1 ? static_cast<float>(start) / static_cast<float>(levels.size() - 1) : 1.0F;
}

LevelBlend::Plan LevelBlend::plan(float fidelity) const noexcept {
    const double f = fidelity > 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    const std::size_t last = levels.size() - 1;
    double place = f * static_cast<double>(last);
    // A level's exact fidelity is rarely a float; without rounding, the next level would be summed in vain.
    if (std::abs(place - std::round(place)) < kOnLevel) place = std::round(place);
    const auto lower = std::min(static_cast<std::size_t>(place), last);
    const double blend = place - static_cast<double>(lower);
    return {lower, blend > 0.0 ? lower + 1 : lower, blend};
}

std::uint32_t LevelBlend::items(float fidelity) const noexcept {
    return static_cast<std::uint32_t>(levels[plan(fidelity).upper].size());
}

double LevelBlend::error_n(std::size_t level) const noexcept { return error_scale * metrics[level].error_n; }

PathLoad LevelBlend::predict(float fidelity) const noexcept {
    const Plan p = plan(fidelity);
    PathLoad load;
    load.cost_predicted = metrics[p.lower].cost + (p.upper != p.lower ? metrics[p.upper].cost : Duration{0});
    load.error = (1.0 - p.blend) * error_n(p.lower) + p.blend * error_n(p.upper);
    load.items = static_cast<std::uint32_t>(levels[p.upper].size());
    return load;
}

PartialSums::Result LevelBlend::sum_level(std::size_t level, const Pose& T_model_body, const Budget& budget,
                                          KeptSums* kept) const noexcept {
    const PointSet& points = levels[level];
    const Deadline deadline = points.size() > DockingParts::kAlways ? budget.deadline : Deadline();
    return sum_of_step(map_of(level), points, T_model_body, static_cast<double>(budget.work_fraction),
                       deadline, kept != nullptr ? &(*kept)[level % kept->size()] : nullptr);
}

Wrench LevelBlend::wrench(const DensitySums& sums) const noexcept {
    return {newtons_per_gradient * sums.gradient, energy_j_per_sigma * sums.moment};
}

StepResult LevelBlend::evaluate(const Pose& T_model_body, const Budget& budget,
                                KeptSums* kept) const noexcept {
    const Instant begin = Monotonic::now();
    StepResult result;
    if (!T_model_body.finite()) {
        result.status = StepStatus::out_of_range;
        return result;
    }
    result.load = predict(budget.fidelity);
    const Plan p = plan(budget.fidelity);
    const auto use = [&](std::size_t level, const PartialSums::Result& sum) {
        result.wrench_world = wrench(sum.sums);
        result.load.error = error_n(level) + newtons_per_gradient * sum.stale;
        result.load.items = static_cast<std::uint32_t>(levels[level].size());
        result.load.recomputed_fraction = sum.recomputed_fraction;
    };
    const std::size_t wanted = levels[p.lower].size();
    if (wanted > DockingParts::kAlways) {  // sum a fallback that is small beside the whole
        std::size_t safe = 0;
        while (levels[safe + 1].size() <= std::min(DockingParts::kAlways, wanted / kSafeShare)) ++safe;
        use(safe, sum_level(safe, T_model_body, budget, nullptr));
    }
    const PartialSums::Result lower = sum_level(p.lower, T_model_body, budget, kept);
    if (!lower.complete) {
        result.status = StepStatus::out_of_time;
        result.load.work_done = std::max(lower.recomputed_fraction, kPartLeast);
    } else {
        use(p.lower, lower);
        bool late = lower.late;
        if (p.upper != p.lower) {
            const PartialSums::Result upper = sum_level(p.upper, T_model_body, budget, kept);
            late = late || upper.late;
            if (upper.complete) {
                const Wrench a = wrench(lower.sums), b = wrench(upper.sums);
                result.wrench_world.force_n = (1.0 - p.blend) * a.force_n + p.blend * b.force_n;
                result.wrench_world.torque_n_m = (1.0 - p.blend) * a.torque_n_m + p.blend * b.torque_n_m;
                const PathLoad promised = predict(budget.fidelity);
                result.load.error = promised.error + newtons_per_gradient * ((1.0 - p.blend) * lower.stale +
                                                                             p.blend * upper.stale);
                result.load.items = promised.items;
                const auto m = static_cast<float>(wanted), n = static_cast<float>(levels[p.upper].size());
                result.load.recomputed_fraction =
                    (m * lower.recomputed_fraction + n * upper.recomputed_fraction) / (m + n);
            }
        }
        if (late || budget.deadline.passed()) result.status = StepStatus::out_of_time;
        if (late) result.load.work_done = std::max(result.load.recomputed_fraction, kPartLeast);
    }
    result.load.cost = Monotonic::now() - begin;
    return result;
}

}  // namespace tact
