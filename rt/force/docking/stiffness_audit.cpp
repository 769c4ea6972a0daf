#include "rt/force/docking/stiffness_audit.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/scene/density/climb.hpp"

namespace tact {

const StiffnessAudit::Seen* StiffnessAudit::seen(std::size_t level) const noexcept {
    const Seen& s = seen_[level % seen_.size()];
    return s.level == level ? &s : nullptr;
}

BendNorms StiffnessAudit::measured(std::size_t level) const noexcept {
    const Seen* const s = seen(level);
    return s != nullptr ? s->norms : BendNorms{-1.0, -1.0};
}

void StiffnessAudit::step(const LevelBlend& blend, float fidelity, const Pose& T_model_body, double step_s,
                          BendNorms& scale) noexcept {
    const LevelBlend::Plan plan = blend.plan(fidelity);
    if (level_ != plan.lower && level_ != plan.upper) level_ = kNone;
    if (level_ == kNone) {
        // The one without a measurement, or with the older one.
        const auto order = [&](std::size_t level) { return seen(level) != nullptr ? seen(level)->order : 0; };
        level_ = order(plan.upper) < order(plan.lower) ? plan.upper : plan.lower;
        next_ = 0;
        pose_ = T_model_body;
        sum_ = {};
    }
    const PointSet& points = blend.levels[level_];
    const double pass_s = plan.upper != plan.lower ? kPassOfTwo_s : kPass_s;
    const double part = std::clamp(step_s / pass_s, 0.0, 1.0) * static_cast<double>(points.size());
    const std::size_t slice = std::max(static_cast<std::size_t>(std::ceil(part)), kSliceMin);
    const std::size_t n = std::min(slice, points.size() - next_);
    const DensityBends bends = blend.map_of(level_).bends(points.view(next_, n), pose_);
    sum_.by_shift += bends.by_shift;
    sum_.by_turn += bends.by_turn;
    next_ += n;
    if (next_ >= points.size()) finish(blend, scale);
}

void StiffnessAudit::finish(const LevelBlend& blend, BendNorms& scale) noexcept {
    Seen& s = seen_[level_ % seen_.size()];
    s.norms = {spectral_norm(sum_.by_shift), spectral_norm(sum_.by_turn)};
    s.at = pose_;
    s.level = level_;
    s.order = ++done_;
    const BendNorms& most = blend.metrics[level_].bends;
    if (most.by_shift > 0.0) scale.by_shift = std::max(scale.by_shift, s.norms.by_shift / most.by_shift);
    if (most.by_turn > 0.0) scale.by_turn = std::max(scale.by_turn, s.norms.by_turn / most.by_turn);
    level_ = kNone;
}

BendNorms StiffnessAudit::bound_of(const LevelBlend& blend, std::size_t level, const Pose& T_model_body,
                                   const BendNorms& scale) const noexcept {
    const BendNorms& metrics = blend.metrics[level].bends;
    const BendNorms most{scale.by_shift * metrics.by_shift, scale.by_turn * metrics.by_turn};
    const Seen* const s = seen(level);
    if (s == nullptr) return most;
    const double far_m = kFarVoxels * blend.map_of(level).spacing_m().minCoeff();
    const double way = motion_m(s->at, T_model_body, blend.levels[level].radius_m) / far_m;
    if (!(way < 1.0)) return most;
    return {std::min(most.by_shift, s->norms.by_shift + way * most.by_shift),
            std::min(most.by_turn, s->norms.by_turn + way * most.by_turn)};
}

BendNorms StiffnessAudit::bound(const LevelBlend& blend, float fidelity, const Pose& T_model_body,
                                const BendNorms& scale) const noexcept {
    const LevelBlend::Plan plan = blend.plan(fidelity);
    const BendNorms lower = bound_of(blend, plan.lower, T_model_body, scale);
    if (plan.upper == plan.lower) return lower;
    const BendNorms upper = bound_of(blend, plan.upper, T_model_body, scale);
    return {(1.0 - plan.blend) * lower.by_shift + plan.blend * upper.by_shift,
            (1.0 - plan.blend) * lower.by_turn + plan.blend * upper.by_turn};
}

}  // namespace tact
