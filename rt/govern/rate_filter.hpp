// Is the rate off its goal, or does it only flicker? A mean since the last change, with its uncertainty.
//
// Judged   off, once the mean is further from the goal than the tolerance plus kSure standard errors of the
//          mean: a big error is believed after one interval, a small one after as many as it takes
// Flicker  the standard deviation of an interval's rate, from the differences of intervals next to each
//          other, so that a step of the load does not count as flicker
// Forgets  by the weight of kIntervalsMax intervals; at once when the rate leaps, and on restart()
// Bounded  whatever comes in: rates are cut to [0, 10] goals, the flicker to its own limits
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/rt.hpp"
#include "rt/govern/law.hpp"

namespace tact {

class RateFilter {
public:
    static constexpr double kIntervalsMax = 50.0;
    static constexpr double kSure = 1.5;
    static constexpr double kLeap = 5.0;                             // flickers
    static constexpr double kFlickerMin = 0.002, kFlickerMax = 0.1;  // of the goal

    // rate_hz finite and not negative, goal_hz > 0.
    void add(double rate_hz, double goal_hz) noexcept TACT_RT {
        const double r = std::min(rate_hz / goal_hz, 10.0);
        if (n_ > 0.0) {
            const double d = r - last_;
            if (std::abs(r - mean_) > kLeap * flicker()) n_ = 0.0;
            // Differences beyond a leap say nothing about flicker.
            const double cut = std::min(d * d, kLeap * kLeap * variance_ * 2.0);
            variance_ += 0.05 * (0.5 * cut - variance_);
            variance_ = std::clamp(variance_, kFlickerMin * kFlickerMin, kFlickerMax * kFlickerMax);
        }
        n_ = std::min(n_ + 1.0, kIntervalsMax);
        mean_ = n_ <= 1.0 ? r : mean_ + (r - mean_) / n_;
        last_ = r;
    }
    void restart() noexcept TACT_RT { n_ = 0.0; }

    [[nodiscard]] RateIs judge(double tolerance) const noexcept TACT_RT {
        if (n_ < 1.0) return RateIs::right;
        const double band = tolerance + kSure * flicker() / std::sqrt(n_);
        if (error() < -band) return RateIs::low;
        if (error() > band) return RateIs::high;
        return RateIs::right;
    }
    [[nodiscard]] double error() const noexcept TACT_RT { return mean_ - 1.0; }  // of the goal
    [[nodiscard]] double flicker() const noexcept TACT_RT { return std::sqrt(variance_); }

private:
    double n_ = 0.0, mean_ = 1.0, last_ = 1.0;
    double variance_ = 0.02 * 0.02;
};

}  // namespace tact
