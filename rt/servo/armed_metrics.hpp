// Metrics of armed cycles: deadline misses, published error, largest force step, settling time of the level.
//
// Counted   cycles in which force may flow, since the loop started. The level history restarts at each arming.
// Thread    servo; constant time, no allocation
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

// Finds when the level last differed by more than kBand from its present value.
class LevelHistory {
public:
    static constexpr double kBand = 0.05;  // relative to the present level
    static constexpr std::size_t kBins = 256;

    void start(Instant now) noexcept TACT_RT {
        seen_.fill(Instant::min());
        begun_at_ = now;
    }
    void add(double level, Instant now) noexcept TACT_RT {
        now_level_ = level;
        seen_[bin(level)] = now;
    }
    // Settling time (s) after start(); 0: the level never left the band.
    [[nodiscard]] double settled_s() const noexcept TACT_RT {
        Instant last = begun_at_;
        for (std::size_t i = 0; i < kBins; ++i) {
            const double nearest =
                std::clamp(now_level_, static_cast<double>(i) / kBins, static_cast<double>(i + 1) / kBins);
            if (std::abs(nearest - now_level_) > kBand * now_level_) last = std::max(last, seen_[i]);
        }
        return to_s(last - begun_at_);
    }

private:
    static std::size_t bin(double level) noexcept {
        return std::min(static_cast<std::size_t>(std::clamp(level, 0.0, 1.0) * kBins), kBins - 1);
    }
    std::array<Instant, kBins> seen_{};
    Instant begun_at_{};
    double now_level_ = 0.0;
};

class ArmedMetrics {
public:
    struct Cycle {
        bool armed = false;
        bool deadline_missed = false;
        double level = 1.0;                 // level of the haptic path
        double error_n = 0.0;               // published bound
        Vec3 force_world_n = Vec3::Zero();  // sent to the first device
    };

    void add(const Cycle& c, Instant now) noexcept TACT_RT {
        if (!c.armed) {
            armed_ = false;
            return;
        }
        if (!armed_) history_.start(now);
        if (armed_)
            force_step_n_max_ = std::max(force_step_n_max_, (c.force_world_n - force_before_n_).norm());
        armed_ = true;
        force_before_n_ = c.force_world_n;
        ++cycles_;
        ++second_cycles_;
        if (c.deadline_missed) {
            ++deadline_misses_;
            ++second_misses_;
            missed_at_ = now;
        }
        history_.add(c.level, now);
        error_.add(Duration(std::llround(1e9 * std::clamp(c.error_n, 0.0, 4.0))));
    }
    // Call once a second.
    void second_over() noexcept TACT_RT {
        last_second_share_ = share(second_misses_, second_cycles_);
        second_misses_ = second_cycles_ = 0;
    }

    [[nodiscard]] std::uint64_t cycles() const noexcept TACT_RT { return cycles_; }
    [[nodiscard]] std::uint64_t deadline_misses() const noexcept TACT_RT { return deadline_misses_; }
    [[nodiscard]] double last_second_share() const noexcept TACT_RT { return last_second_share_; }
    [[nodiscard]] Instant missed_at() const noexcept TACT_RT { return missed_at_; }  // epoch: never
    [[nodiscard]] double force_error_n_p50() const noexcept TACT_RT {
        return 1e-9 * static_cast<double>(error_.percentile_ns(0.5));
    }
    [[nodiscard]] double force_step_n_max() const noexcept TACT_RT { return force_step_n_max_; }
    // Settling time (s) after the last arming; negative before the first arming.
    [[nodiscard]] double level_settled_s() const noexcept TACT_RT {
        return cycles_ > 0 ? history_.settled_s() : -1.0;
    }

private:
    static double share(std::uint64_t part, std::uint64_t all) noexcept {
        return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
    }
    bool armed_ = false;
    std::uint64_t cycles_ = 0, deadline_misses_ = 0, second_cycles_ = 0, second_misses_ = 0;
    double last_second_share_ = 0.0, force_step_n_max_ = 0.0;
    Vec3 force_before_n_ = Vec3::Zero();
    Instant missed_at_{};
    LevelHistory history_;
    DurationHistogram error_;  // in nanonewtons, up to 4 N
};

}  // namespace tact
