// Distribution of measured step costs about their predictions: speed, spread, slowest steps and interrupts (level_fit.hpp).
//
// Speed       streaming median of measured / predicted cost: each sample moves it by kStep towards itself. kLeapRun
//             samples in a row above kLeap times the speed set it to their least, as many below it to their largest: the
//             processor became slower or faster
// Spread      decaying histogram of cost / (speed x predicted) in bins of 2 %. It starts with kPrior samples of the
//             predicted cost, so one early outlier does not define the tail. It does not hold the samples of a leap
// Slowest     histogram of cost / predicted, whatever the speed, over the present and the previous window; turn() begins a
//             new one. It starts with the same kPrior samples
// Interrupts  decaying histogram of the excess cost in bins of 25 % from 1 us. Of kInterruptRun interrupted samples in a
//             row or more, the last belong to the slowest steps instead
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
        now_.add(slowest_bin(1.0), kPrior);
    }
    void turn() noexcept TACT_RT {
        before_ = now_;
        now_ = {};
    }
    enum class Kind { usual, interrupted, changed };
    static constexpr std::size_t kInterruptRun = 4;
    static constexpr std::size_t kLeapRun = 16;
    static constexpr double kLeap = 1.1;

    Kind add(double cost_s, double predicted_s, double speed_least) noexcept TACT_RT {
        if (!(predicted_s > 0.0) || !(cost_s >= 0.0)) return Kind::usual;
        const double ratio = cost_s / predicted_s, usual_s = speed_ * predicted_s;
        const bool interrupted = ratio > kInterrupted * speed_ && cost_s > usual_s + kInterruptLeast_s;
        if (total_ >= kMemory) decay();
        if (interrupted && run_ < kInterruptRun) excess_[run_] = excess_bin(cost_s - usual_s);
        if (!interrupted && run_ < kInterruptRun)
            for (; run_ > 0; --run_) count(interrupt_, excess_[run_ - 1]);
        run_ = interrupted ? run_ + 1 : 0;
        if (run_ == 0 || run_ >= kInterruptRun) now_.add(slowest_bin(ratio), 1.0);

        if (slower_.add(ratio, ratio > kLeap * speed_)) {
            speed_ = slower_.least;
            run_ = leap_ = 0;
            return Kind::changed;
        }
        if (faster_.add(ratio, kLeap * ratio < speed_)) {
            speed_ = std::max(faster_.most, speed_least);
            return Kind::usual;
        }
        if (interrupted) return run_ < kInterruptRun ? Kind::interrupted : Kind::usual;
        if (slower_.length > 0) {
            leap_bin_[leap_++] = bin(ratio / speed_);
            return Kind::usual;
        }
        for (; leap_ > 0; --leap_) count(ratio_, leap_bin_[leap_ - 1]);
        speed_ = std::max(speed_ * (ratio > speed_ ? 1.0 + kStep : 1.0 - kStep), speed_least);
        count(ratio_, bin(ratio / speed_));
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
    // Ratio to the predicted cost that a fraction `tail` of the steps of the last windows exceeds.
    [[nodiscard]] double slowest(double tail = kTail) const noexcept TACT_RT {
        const double most = tail * (now_.total + before_.total);
        double above = 0.0;
        for (std::size_t i = std::max(now_.end, before_.end); i-- > 0;) {
            above += now_.count[i] + before_.count[i];
            if (above > most) return kLeast * std::exp(kWidth * static_cast<double>(i + 1));
        }
        return 1.0;
    }
    // That `slowest` counts.
    [[nodiscard]] double samples() const noexcept TACT_RT { return now_.total + before_.total - kPrior; }
    // Excess (s) that a fraction kTail of the steps exceeds, not counting those above most_s; 0 where fewer are interrupted.
    [[nodiscard]] double interrupt_s(double most_s) const noexcept TACT_RT {
        double above = 0.0;
        for (std::size_t i = excess_bin(std::max(most_s, 0.0)) + 1; i-- > 0;) {
            above += interrupt_[i];
            if (above > kTail * total_) return 1e-6 * std::exp(kExcessWidth * (static_cast<double>(i) + 1.0));
        }
        return 0.0;
    }

private:
    static constexpr double kStep = 0.004, kPrior = 2000.0, kMemory = 16000.0;
    static constexpr double kLeast = 0.5, kWidth = 0.02;  // smallest ratio; bin width in ln
    static constexpr double kExcessWidth = 0.2231;        // ln 1.25
    static constexpr std::size_t kBins = 72, kSlowestBins = 150, kExcessBins = 48;  // up to 2.1 and 10 times

    struct Window {
        std::array<double, kSlowestBins> count{};
        double total = 0.0;
        std::size_t end = 0;  // behind the last bin in use
        void add(std::size_t bin, double samples) noexcept TACT_RT {
            count[bin] += samples;
            total += samples;
            end = std::max(end, bin + 1);
        }
    };

    // Samples in a row on one side of the speed. True: there are kLeapRun of them; another run begins.
    struct Run {
        std::size_t length = 0;
        double least = 0.0, most = 0.0;
        bool add(double ratio, bool belongs) noexcept TACT_RT {
            if (!belongs || length == kLeapRun) length = 0;
            if (!belongs) return false;
            least = length == 0 ? ratio : std::min(least, ratio);
            most = length == 0 ? ratio : std::max(most, ratio);
            return ++length == kLeapRun;
        }
    };
    template <std::size_t kCount>
    void count(std::array<double, kCount>& histogram, std::size_t bin) noexcept TACT_RT {
        histogram[bin] += 1.0;
        total_ += 1.0;
    }
    static std::size_t bin(double ratio) noexcept TACT_RT { return std::min(slowest_bin(ratio), kBins - 1); }
    static std::size_t slowest_bin(double ratio) noexcept TACT_RT {
        const double place = std::log(std::max(ratio, kLeast) / kLeast) / kWidth;
        return static_cast<std::size_t>(std::min(place, static_cast<double>(kSlowestBins - 1)));
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
    std::size_t run_ = 0;  // interrupted samples in a row
    std::array<std::size_t, kInterruptRun> excess_{};
    Run slower_, faster_;
    std::size_t leap_ = 0;  // samples of slower_ that are not interrupted, not yet in a histogram
    std::array<std::size_t, kLeapRun> leap_bin_{};
    std::array<double, kBins> ratio_{};
    std::array<double, kExcessBins> interrupt_{};
    Window now_, before_;
};

}  // namespace tact
