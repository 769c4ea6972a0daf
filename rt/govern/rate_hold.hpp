// Holds the rate of a free-running loop within 0.1 s. This inner loop acts per update; the governor's law waits
// for whole intervals and for the display to apply its levels.
//
// Behind    computes the fraction of its work that a step recomputes (Budget::work_fraction). For every span up
//           to kWindow_s, the deficit is the updates due at the goal rate minus those made. A whole window may
//           lack kSlack of its updates. A shorter span may lack more, by the number that a loop at kCatchUp times
//           the goal recovers before the window ends, so short interruptions within a window cost nothing. A
//           further deficit of kRange of a window lowers the fraction from 1 to kLeast
// Ahead     computes how long the loop may sleep and so leave the processor to others: until its lead over a rate
//           kAbove the goal is kAhead of a window. A constant lead does not change the mean rate. An earlier
//           deficit counts for up to kLacked of a window: a loop that never reaches its goal on average does not sleep in the
//           moments in which it is faster, between the frames of a display
// Stalls    a gap counts as at most kGap_s, so the loop recovers at most a quarter of a window; updates from
//           before the window do not count
// Runs on   servo thread, once per update, constant time
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class RateHold {
public:
    static constexpr double kWindow_s = 0.1, kGap_s = 0.025;
    static constexpr double kSlack = 0.01, kRange = 0.02;          // fractions of a window's updates
    static constexpr double kSlackLeast = 1.0, kRangeLeast = 2.0;  // updates
    static constexpr double kCatchUp = 1.15;
    static constexpr double kLeast = 0.125;
    static constexpr double kAbove = 0.005, kAhead = 0.03, kLacked = 0.5, kRestMost_s = 1e-3;

    // Starts without a deficit or a lead.
    void restart() noexcept TACT_RT { *this = {}; }

    // Call as an update begins; counts it. Returns the fraction of its work to recompute. goal_hz > 0.
    [[nodiscard]] double work_fraction(Instant now, double goal_hz) noexcept TACT_RT {
        advance(now, goal_hz);
        const double lacking = most_lacking(goal_hz);
        made_[slot_ % made_.size()] += 1.0;
        ahead_ =
            std::min(ahead_ + 1.0, 2.0 * lead(goal_hz));  // limits the lead where the loop does not sleep
        const double range = std::max(kRange * goal_hz * kWindow_s, kRangeLeast);
        return std::clamp(1.0 - (1.0 - kLeast) * lacking / range, kLeast, 1.0);
    }
    // Call before an update. Returns the time to sleep, at most kRestMost_s.
    [[nodiscard]] double rest_s(Instant now, double goal_hz) noexcept TACT_RT {
        advance(now, goal_hz);
        return std::clamp((ahead_ - lead(goal_hz)) / goal_hz, 0.0, kRestMost_s);
    }

private:
    static constexpr std::size_t kSlots = 20;
    static constexpr double kSlot_s = kWindow_s / kSlots;

    static double slack(double goal_hz) noexcept TACT_RT {
        return std::max(kSlack * goal_hz * kWindow_s, kSlackLeast);
    }
    static double lead(double goal_hz) noexcept TACT_RT {
        return std::max(kAhead * goal_hz * kWindow_s, 1.0);
    }
    void advance(Instant now, double goal_hz) noexcept TACT_RT {
        const double dt_s = begun_ ? std::clamp(to_s(now - before_), 0.0, kGap_s) : 0.0;
        t_s_ += dt_s;
        ahead_ = std::max(ahead_ - (1.0 + kAbove) * goal_hz * dt_s, -kLacked * goal_hz * kWindow_s);
        begun_ = true;
        before_ = now;
        const auto slot = static_cast<std::uint64_t>(t_s_ / kSlot_s);
        for (; slot_ < slot; ++slot_) made_[(slot_ + 1) % made_.size()] = 0.0;
    }
    // Time since the beginning of the slot that lies `back` slots before the present one.
    [[nodiscard]] double since_s(std::uint64_t back) const noexcept TACT_RT {
        return t_s_ - static_cast<double>(slot_ - back) * kSlot_s;
    }
    // Updates in that slot; the oldest slot counts by the part of it that lies in the window.
    [[nodiscard]] double made_within(std::uint64_t back) const noexcept TACT_RT {
        const double part = (kWindow_s + kSlot_s - since_s(back)) / kSlot_s;
        return made_[(slot_ - back) % made_.size()] * std::clamp(part, 0.0, 1.0);
    }
    // Largest deficit beyond the permitted one, over all spans that end now.
    [[nodiscard]] double most_lacking(double goal_hz) const noexcept TACT_RT {
        double most = 0.0, made = 0.0;
        for (std::uint64_t back = 0; back <= std::min<std::uint64_t>(slot_, kSlots); ++back) {
            made += made_within(back);
            const double span_s = std::min(since_s(back), kWindow_s);
            const double later = (kCatchUp - 1.0) * goal_hz * (kWindow_s - span_s);
            most = std::max(most, goal_hz * span_s - made - slack(goal_hz) - later);
        }
        return most;
    }

    std::array<double, kSlots + 1> made_{};
    std::uint64_t slot_ = 0;
    double t_s_ = 0.0;    // since the restart, gaps clamped
    double ahead_ = 0.0;  // lead in updates; negative: deficit
    Instant before_{};
    bool begun_ = false;
};

}  // namespace tact
