// Distribution of measured step costs about their predictions: speed, spread and interrupts (level_fit.hpp).
//
// Speed       streaming median of measured / predicted cost: each sample moves it by kStep towards itself. kLeapRun
//             samples in a row above kLeap times the speed set it to their least: the processor became slower
// Spread      decaying histogram of cost / (speed x predicted) in bins of 2 %. It starts with kPrior samples of the
//             predicted cost, so one early outlier does not define the tail
// Interrupts  decaying histogram of the excess cost in bins of 25 % from 1 us. kChangedRun interrupted samples in a row
//             count as a change of cost instead: the speed becomes their smallest ratio at once
// Thread      servo; constant time
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ipc/base/rt.hpp"

namespace tact {

class CostSpread {
public:
    // Fraction above each quantile: half of the whole for usual steps, half for interrupted ones.
    static constexpr double kTail = 5e-4;
    static constexpr double kInterrupted = 1.6;  // times the usual cost and kInterruptLeast_s above it
    static constexpr double kInterruptLeast_s = 5e-6;

    void restart() noexcept TACT_RT {
        *this = {};
        ratio_[bin(1.0)] = kPrior;
        total_ = kPrior;
    }
    enum class Kind { usual, interrupted, changed };
    static constexpr std::size_t kChangedRun = 4;
    static constexpr std::size_t kLeapRun = 16;  // samples in a row above kLeap: the processor became slower
    static constexpr double kLeap = 1.1;

    Kind add(double cost_s, double predicted_s, double speed_least) noexcept TACT_RT {
        if (!(predicted_s > 0.0) || !(cost_s >= 0.0)) return Kind::usual;
        const double ratio = cost_s / predicted_s, usual_s = speed_ * predicted_s;
        const bool interrupted = ratio > kInterrupted * speed_ && cost_s > usual_s + kInterruptLeast_s;
        if (total_ >= kMemory) decay();
        if (interrupted) {
            run_least_ = run_ == 0 ? ratio : std::min(run_least_, ratio);
            run_excess_[run_++] = excess_bin(cost_s - usual_s);
            if (run_ < kChangedRun) return Kind::interrupted;
            run_ = 0;
            speed_ = run_least_;
            return Kind::changed;
        }
        for (; run_ > 0; --run_) {
            interrupt_[run_excess_[run_ - 1]] += 1.0;
            total_ += 1.0;
        }
        if (ratio > kLeap * speed_) {
            leap_least_ = leap_ == 0 ? ratio : std::min(leap_least_, ratio);
            leap_bin_[leap_++] = bin(ratio / speed_);
            if (leap_ < kLeapRun) return Kind::usual;
            leap_ = 0;
            speed_ = leap_least_;
            return Kind::changed;
        }
        for (; leap_ > 0; --leap_) count(leap_bin_[leap_ - 1]);
        speed_ = std::max(speed_ * (ratio > speed_ ? 1.0 + kStep : 1.0 - kStep), speed_least);
        count(bin(ratio / speed_));
        return Kind::usual;
    }
    [[nodiscard]] double speed() const noexcept TACT_RT { return speed_; }
    [[nodiscard]] double spread(double tail = kTail) const noexcept TACT_RT {
        double above = 0.0;
        for (std::size_t i = kBins; i-- > 0;) {
            above += ratio_[i];
            if (above > tail * total_) return std::max(upper(i), 1.0);
        }
        return 1.0;
    }
    // Excess (s) that a fraction kTail of the steps exceeds; 0 where fewer steps are interrupted.
    [[nodiscard]] double interrupt_s() const noexcept TACT_RT {
        double above = 0.0;
        for (std::size_t i = kExcessBins; i-- > 0;) {
            above += interrupt_[i];
            if (above > kTail * total_) return 1e-6 * std::exp(kExcessWidth * (static_cast<double>(i) + 1.0));
        }
        return 0.0;
    }

private:
    static constexpr double kStep = 0.004, kPrior = 2000.0, kMemory = 16000.0;
    static constexpr double kLeast = 0.5, kWidth = 0.02;  // smallest ratio; bin width in ln
    static constexpr double kExcessWidth = 0.2231;        // ln 1.25
    static constexpr std::size_t kBins = 72, kExcessBins = 48;

    void count(std::size_t bin) noexcept TACT_RT {
        ratio_[bin] += 1.0;
        total_ += 1.0;
    }
    static std::size_t bin(double ratio) noexcept TACT_RT {
        const double place = std::log(std::max(ratio, kLeast) / kLeast) / kWidth;
        return std::min(static_cast<std::size_t>(place), kBins - 1);
    }
    static double upper(std::size_t bin) noexcept TACT_RT {
        return kLeast * std::exp(kWidth * static_cast<double>(bin + 1));
    }
    static std::size_t excess_bin(double excess_s) noexcept TACT_RT {
        return std::min(static_cast<std::size_t>(std::max(std::log(1e6 * excess_s) / kExcessWidth, 0.0)),
                        kExcessBins - 1);
    }
    void decay() noexcept TACT_RT {
        for (double& n : ratio_) n *= 0.5;
        for (double& n : interrupt_) n *= 0.5;
        total_ *= 0.5;
    }

    double speed_ = 1.0, total_ = 0.0;
    std::size_t run_ = 0;  // interrupted samples in a row, not yet in a histogram
    double run_least_ = 0.0;
    std::array<std::size_t, kChangedRun> run_excess_{};
    std::size_t leap_ = 0;  // samples above kLeap in a row, not yet in a histogram
    double leap_least_ = 0.0;
    std::array<std::size_t, kLeapRun> leap_bin_{};
    std::array<double, kBins> ratio_{};
    std::array<double, kExcessBins> interrupt_{};
};

}  // namespace tact
