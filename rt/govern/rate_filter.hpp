// Separates an error of the rate from flicker: mean rate since the last change, with its standard error.
//
// Off      the mean differs from the goal by more than the tolerance plus kSure standard errors: the larger the
//          error, the fewer intervals it takes
// Flicker  standard deviation of the rate per interval, estimated from differences of consecutive intervals, so
//          that a step of the load does not count as flicker
// Jumps    other programs may hold the processor for an interval or two, which rate_hold.hpp covers. An interval that is
//          more than kLeap standard deviations off counts as one deviation, until kLows in a row are below the mean or
//          kHighs above it: then their mean is the new one
// Memory   at most kIntervalsMax intervals; cleared by a jump and by restart()
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
    static constexpr double kLeap = 5.0;                             // standard deviations
    static constexpr int kLows = 3, kHighs = 2;                      // intervals
    static constexpr double kFlickerMin = 0.002, kFlickerMax = 0.1;  // relative to the goal

    // rate_hz finite and not negative, goal_hz > 0.
    void add(double rate_hz, double goal_hz) noexcept TACT_RT {
        const double r = std::min(rate_hz / goal_hz, 10.0), usual = n_ > 0.0 ? mean_ : 1.0;
        const int side = std::abs(r - usual) <= kLeap * flicker() ? 0 : r < usual ? -1 : 1;
        far_ = side != 0 && side == far_side_ ? far_ + 1 : 1;
        far_side_ = side;
        far_mean_ = far_ == 1 ? r : far_mean_ + (r - far_mean_) / far_;
        if (side == 0) {
            if (n_ > 0.0) follow_flicker(r - last_);
            last_ = r;
            return count(r);
        }
        const int jump = side < 0 ? kLows : kHighs;
        if (far_ < jump) {
            if (n_ > 0.0) count(usual + side * flicker());
            return;
        }
        // Of a jump the last interval counts twice; those after it belong to a rate that still moves.
        last_ = r;
        n_ = far_ == jump ? far_ : 1.0;
        mean_ = far_ == jump ? far_mean_ + (r - far_mean_) / far_ : r;
    }
    void restart() noexcept TACT_RT {
        n_ = 0.0;
    }  // intervals far from the mean go on: a step seldom suffices

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
    void count(double r) noexcept TACT_RT {
        n_ = std::min(n_ + 1.0, kIntervalsMax);
        mean_ = n_ <= 1.0 ? r : mean_ + (r - mean_) / n_;
    }
    void follow_flicker(double difference) noexcept TACT_RT {
        const double cut = std::min(difference * difference, kLeap * kLeap * variance_ * 2.0);
        variance_ += 0.05 * (0.5 * cut - variance_);
        variance_ = std::clamp(variance_, kFlickerMin * kFlickerMin, kFlickerMax * kFlickerMax);
    }

    double n_ = 0.0, mean_ = 1.0, last_ = 1.0;
    int far_ = 0, far_side_ = 0;  // intervals in a row far from the mean, and their side of it
    double far_mean_ = 1.0;
    double variance_ = 0.02 * 0.02;
};

}  // namespace tact
