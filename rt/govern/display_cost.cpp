#include "rt/govern/display_cost.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

namespace {

bool is_level(double level) noexcept { return level > 0.0 && level <= 1.0; }

}  // namespace

void DisplayCost::add(const PerPath& level, const PerPath& share, double frame_s) noexcept {
    if (!(frame_s > 0.0 && frame_s < 1e3)) return;
    PerPath now{};
    bool same = true, reported = false;
    std::size_t first = kPathsMax;
    for (std::size_t i = 0; i < kPathsMax; ++i) {
        now[i] = is_level(level[i]) ? level[i] : 0.0;
        same = same && (now[i] > 0.0) == (mean_[i] > 0.0);
        if (now[i] > 0.0 && first == kPathsMax) first = i;
        share_[i] = now[i] > 0.0 && share[i] > 0.0 ? std::min(share[i], 1.0) : 0.0;
        reported = reported || share_[i] > 0.0;
    }
    if (!reported && first < kPathsMax) share_[first] = 1.0;
    if (!same) {  // another set of paths: nothing measured applies
        frames_ = mean_s_ = 0.0;
        mean_ = with_time_ = PerPath{};
        with_level_ = {};
    }
    frames_ = std::min(frames_ + 1.0, kMemory);
    const double a = 1.0 / frames_, dt = frame_s - mean_s_;
    PerPath d{};
    for (std::size_t i = 0; i < kPathsMax; ++i) {
        d[i] = now[i] - mean_[i];
        mean_[i] += a * d[i];
    }
    mean_s_ += a * dt;
    for (std::size_t i = 0; i < kPathsMax; ++i) {
        with_time_[i] += a * ((1.0 - a) * d[i] * dt - with_time_[i]);
        for (std::size_t k = 0; k < kPathsMax; ++k)
            with_level_[i][k] += a * ((1.0 - a) * d[i] * d[k] - with_level_[i][k]);
    }
}

// (S + W) rate = c + W prior, by Gauss without pivots: S + W is positive definite, because S is a covariance and every
// diagonal entry of W is positive.
DisplayCost::PerPath DisplayCost::rates() const noexcept {
    std::array<PerPath, kPathsMax> m = with_level_;
    PerPath rate = with_time_;
    for (std::size_t i = 0; i < kPathsMax; ++i) {
        const bool present = mean_[i] > 0.0;
        const double weight = present ? kPriorSpread * kPriorSpread * mean_[i] * mean_[i] : 1.0;
        m[i][i] += weight;
        if (present) rate[i] += weight * 0.5 * share_[i] * mean_s_ / mean_[i];
    }
    for (std::size_t i = 0; i < kPathsMax; ++i)
        for (std::size_t k = i + 1; k < kPathsMax; ++k) {
            const double f = m[k][i] / m[i][i];
            for (std::size_t j = i; j < kPathsMax; ++j) m[k][j] -= f * m[i][j];
            rate[k] -= f * rate[i];
        }
    for (std::size_t i = kPathsMax; i-- > 0;) {
        for (std::size_t k = i + 1; k < kPathsMax; ++k) rate[i] -= m[i][k] * rate[k];
        rate[i] /= m[i][i];
    }
    return rate;
}

DisplayCost::Estimate DisplayCost::at(const PerPath& level) const noexcept {
    Estimate e;
    if (frames_ < 1.0) return e;
    const PerPath rate = rates();
    double frame_s = mean_s_;
    for (std::size_t i = 0; i < kPathsMax; ++i)
        if (mean_[i] > 0.0 && is_level(level[i])) frame_s += rate[i] * (level[i] - mean_[i]);
    // A line through few levels may cross zero: at least the parts that are known to vary remain.
    e.frame_s = std::isfinite(frame_s) ? std::max(frame_s, kLeast * mean_s_) : mean_s_;
    const bool several =
        std::count_if(mean_.begin(), mean_.end(), [](double mean) { return mean > 0.0; }) > 1;
    const double least = several ? kLeastGain : kLeast;
    double sum_s = 0.0;
    for (std::size_t i = 0; i < kPathsMax; ++i) {
        if (!(mean_[i] > 0.0) || !is_level(level[i])) continue;
        const double most_s = share_[i] * e.frame_s, least_s = least * most_s;
        const double gain_s = rate[i] * level[i];
        e.gain_s[i] = std::isfinite(gain_s) ? std::clamp(gain_s, least_s, most_s) : least_s;
        sum_s += e.gain_s[i];
    }
    if (sum_s > e.frame_s)
        for (double& gain_s : e.gain_s) gain_s *= e.frame_s / sum_s;
    return e;
}

double DisplayCost::Estimate::elasticity() const noexcept {
    if (!(frame_s > 0.0)) return 0.5;
    double sum_s = 0.0;
    for (const double s : gain_s) sum_s += s;
    return std::clamp(sum_s / frame_s, kLeast, 1.0);
}

}  // namespace tact
