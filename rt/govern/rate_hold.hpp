// Holds the rate of a freely running loop within a tenth of a second: the fast loop beneath the governor's,
// which has to wait for whole intervals and for the picture to apply.
//
// Behind    how much of its work a step may do anew (Budget::share). Looked at is every span up to kWindow_s:
//           the updates that were due by the goal, less those made. A whole window may lack kSlack of its
//           updates; a shorter span more, by what a loop at kCatchUp times the goal makes good before the
//           window is over, so turns of other programs and pictures that come and go within a window cost
//           nothing. The share falls from 1 to kLeast for kRange of a window's updates more
// Ahead     how long the loop may wait, so that others have the time that it does not need: until it is
//           kAhead of a window ahead of an even rate kAbove the goal: a constant lead, which no mean rate
//           shows. What it lacked before counts for up to kLacked of a window, so turns and pictures that
//           come and go are evened out here too
// Stalls    a gap counts for at most kGap_s, so that no more than a quarter of a window is ever made good,
//           and what lies before the window is forgotten
// Runs on   servo thread, once for each update, constant time
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
    static constexpr double kSlack = 0.01, kRange = 0.02;          // of a window's updates
    static constexpr double kSlackLeast = 1.0, kRangeLeast = 2.0;  // updates
    static constexpr double kCatchUp = 1.15;
    static constexpr double kLeast = 0.125;
    static constexpr double kAbove = 0.005, kAhead = 0.03, kLacked = 0.1, kRestMost_s = 1e-3;

    // From now on; before it, everything was as it should be.
    void restart() noexcept TACT_RT { *this = {}; }

    // As an update begins, which is counted: the share of its work. goal_hz > 0.
    [[nodiscard]] double work_fraction(Instant now, double goal_hz) noexcept TACT_RT {
        advance(now, goal_hz);
        const double lacking = most_lacking(goal_hz);
        made_[slot_ % made_.size()] += 1.0;
        ahead_ = std::min(ahead_ + 1.0, 2.0 * lead(goal_hz));  // a loop that did not rest owes no rest
        const double range = std::max(kRange * goal_hz * kWindow_s, kRangeLeast);
        return std::clamp(1.0 - (1.0 - kLeast) * lacking / range, kLeast, 1.0);
    }
    // Before the next one: how long to wait, at most kRestMost_s.
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
    // Since the beginning of the slot so many back.
    [[nodiscard]] double since_s(std::uint64_t back) const noexcept TACT_RT {
        return t_s_ - static_cast<double>(slot_ - back) * kSlot_s;
    }
    // Updates in the slot so many back; of the last one, only what lies in the window.
    [[nodiscard]] double made_within(std::uint64_t back) const noexcept TACT_RT {
        const double part = (kWindow_s + kSlot_s - since_s(back)) / kSlot_s;
        return made_[(slot_ - back) % made_.size()] * std::clamp(part, 0.0, 1.0);
    }
    // Of all spans that end now: what they lack beyond what they may.
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
    double t_s_ = 0.0;    // since the restart, gaps cut
    double ahead_ = 0.0;  // updates
    Instant before_{};
    bool begun_ = false;
};

}  // namespace tact
