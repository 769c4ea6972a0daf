// Statistics of the servo thread. Constant time per cycle; percentiles once a second.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

// Updates per second over a sliding window of ten slots of 0.1 s.
class RateWindow {
public:
    void start(Instant now) noexcept {
        *this = {};
        begun_at_ = slot_at_ = now;
    }
    void count() noexcept TACT_RT {
        ++in_slot_;
        ++total_;
    }
    // Call every 0.1 s.
    void turn(Instant now) noexcept TACT_RT {
        slots_[next_ % kSlots] = {now - slot_at_, in_slot_};
        ++next_;
        slot_at_ = now;
        in_slot_ = 0;
    }
    [[nodiscard]] double rate_hz() const noexcept TACT_RT {
        Duration length{0};
        std::uint64_t updates = 0;
        for (const Slot& s : slots_) {
            length += s.length;
            updates += s.updates;
        }
        return length.count() > 0 ? static_cast<double>(updates) / to_s(length) : 0.0;
    }
    [[nodiscard]] double mean_hz(Instant now) const noexcept TACT_RT {
        return now > begun_at_ ? static_cast<double>(total_) / to_s(now - begun_at_) : 0.0;
    }

private:
    static constexpr std::size_t kSlots = 10;
    struct Slot {
        Duration length{0};
        std::uint64_t updates = 0;
    };
    std::array<Slot, kSlots> slots_{};
    std::size_t next_ = 0;
    Instant begun_at_{}, slot_at_{};
    std::uint64_t in_slot_ = 0, total_ = 0;
};

// How a free-running loop held its rate in the last 0.1 s: the recomputed fraction of the model's work, and the
// fraction of the time that the loop slept.
class WorkWindow {
public:
    void start(Instant now) noexcept {
        *this = {};
        begun_at_ = now;
    }
    void add(double recomputed) noexcept TACT_RT {
        sum_ += recomputed;
        now_least_ = std::min(now_least_, recomputed);
        ++n_;
    }
    void rested(Duration d) noexcept TACT_RT { rest_ += d; }
    // Call every 0.1 s.
    void turn(Instant now) noexcept TACT_RT {
        mean_ = n_ > 0 ? sum_ / static_cast<double>(n_) : 1.0;
        least_ = now_least_;
        rested_ = now > begun_at_ ? std::min(to_s(rest_) / to_s(now - begun_at_), 1.0) : 0.0;
        sum_ = 0.0;
        n_ = 0;
        now_least_ = 1.0;
        rest_ = Duration{0};
        begun_at_ = now;
    }
    [[nodiscard]] double recomputed_fraction_mean() const noexcept TACT_RT { return mean_; }
    [[nodiscard]] double recomputed_fraction_least() const noexcept TACT_RT { return least_; }
    [[nodiscard]] double rested() const noexcept TACT_RT { return rested_; }  // fraction of the time

private:
    double sum_ = 0.0, now_least_ = 1.0;
    std::uint64_t n_ = 0;
    Duration rest_{0};
    Instant begun_at_{};
    double mean_ = 1.0, least_ = 1.0, rested_ = 0.0;
};

struct WindowMetrics {
    std::int64_t lateness_p50_ns = 0, lateness_p99_ns = 0, lateness_max_ns = 0;
    std::int64_t cost_p50_ns = 0, cost_max_ns = 0;
    std::int64_t delay_p50_ns = 0, delay_p99_ns = 0;  // from the encoders to the motors
};

class ServoStatistics {
public:
    void start(Instant now) noexcept {
        *this = {};
        rate.start(now);
        work.start(now);
        second_at_ = now;
    }
    void late(Duration d) noexcept TACT_RT {
        lateness.add(d);
        window_lateness_.add(d);
    }
    void spent(Duration d) noexcept TACT_RT { window_cost_.add(d); }
    void delayed(Duration d) noexcept TACT_RT { window_delay_.add(d); }
    // True once a second, with new metrics.
    bool second_over(Instant now) noexcept TACT_RT {
        if (now - second_at_ < std::chrono::seconds(1)) {
            if (!whole_second_) metrics = evaluate();
            return false;
        }
        metrics = evaluate();
        whole_second_ = true;
        window_lateness_.clear();
        window_cost_.clear();
        window_delay_.clear();
        second_at_ = now;
        return true;
    }

    RateWindow rate;
    WorkWindow work;
    DurationHistogram lateness;  // since start
    WindowMetrics metrics;       // of the last whole second; in the first second, so far

private:
    [[nodiscard]] WindowMetrics evaluate() const noexcept {
        const auto ns = [](std::uint64_t v) { return static_cast<std::int64_t>(v); };
        return {ns(window_lateness_.percentile_ns(0.5)),
                ns(window_lateness_.percentile_ns(0.99)),
                ns(window_lateness_.max_ns()),
                ns(window_cost_.percentile_ns(0.5)),
                ns(window_cost_.max_ns()),
                ns(window_delay_.percentile_ns(0.5)),
                ns(window_delay_.percentile_ns(0.99))};
    }
    DurationHistogram window_lateness_, window_cost_, window_delay_;
    Instant second_at_{};
    bool whole_second_ = false;
};

}  // namespace tact
