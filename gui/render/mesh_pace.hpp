// Keeps what it takes to adapt the surface within a budget of each frame, on whatever machine this is.
//
// The cost model of MeshCut knows one machine. Here it is compared with the clock: a move that took longer
// than predicted makes the next ones smaller at once; quicker ones are believed slowly.
#pragma once

#include <algorithm>

namespace tact {

class MeshPace {
public:
    // Of the model's nanoseconds, where `budget_s` may pass on the clock.
    [[nodiscard]] double budget_ns(double budget_s) const noexcept { return 1e9 * budget_s / slower_; }
    void took(double predicted_ns, double measured_s) noexcept {
        if (!(predicted_ns >= kWorthNs)) return;  // the clock and one interrupt would be all that is measured
        const double slower = std::clamp(1e9 * measured_s / predicted_ns, 0.25, 16.0);
        slower_ = std::max(slower, slower_ + 0.1 * (slower - slower_));
    }
    [[nodiscard]] double slower() const noexcept { return slower_; }  // than the model

private:
    static constexpr double kWorthNs = 50e3;
    double slower_ = 1.0;
};

}  // namespace tact
