// Separates an error of the rate from flicker: mean rate since the last change, with its standard error.
//
// Off      the mean differs from the goal by more than the tolerance plus kSure standard errors: a large error
//          is significant after one interval, a small one after several
// Flicker  standard deviation of the rate per interval, estimated from differences of consecutive intervals, so
//          that a step of the load does not count as flicker
// Memory   at most kIntervalsMax intervals; cleared when the rate jumps and by restart()
// Bounded  rates are clamped to [0, 10] goals and the flicker to [kFlickerMin, kFlickerMax]
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
    static constexpr double kLeap = 5.0;                             // jump, in standard deviations
    static constexpr double kFlickerMin = 0.002, kFlickerMax = 0.1;  // relative to the goal

    // rate_hz finite and not negative, goal_hz > 0.
    void add(double rate_hz, double goal_hz) noexcept TACT_RT {
        const double r = std::min(rate_hz / goal_hz, 10.0);
        if (n_ > 0.0) {
            const double d = r - last_;
            if (std::abs(r - mean_) > kLeap * flicker()) n_ = 0.0;
            // Differences beyond a jump are not flicker.
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
    [[nodiscard]] double error() const noexcept TACT_RT { return mean_ - 1.0; }  // relative to the goal
    [[nodiscard]] double flicker() const noexcept TACT_RT { return std::sqrt(variance_); }

private:
    double n_ = 0.0, mean_ = 1.0, last_ = 1.0;
    double variance_ = 0.02 * 0.02;
};

}  // namespace tact
