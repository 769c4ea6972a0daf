// Keeps the time to adapt the surface within a budget per frame on any machine.
//
// MeshCut's cost model was measured on one machine. This class compares it with the clock: a move slower than
// predicted reduces the next ones at once; faster moves increase them slowly.
#pragma once

#include <algorithm>

namespace tact {

class MeshPace {
public:
    // In the model's nanoseconds, for `budget_s` on the clock.
    [[nodiscard]] double budget_ns(double budget_s) const noexcept { return 1e9 * budget_s / slower_; }
    void took(double predicted_ns, double measured_s) noexcept {
        if (!(predicted_ns >= kWorthNs)) return;  // clock resolution and interrupts would dominate
        const double slower = std::clamp(1e9 * measured_s / predicted_ns, 0.25, 16.0);
        slower_ = std::max(slower, slower_ + 0.1 * (slower - slower_));
    }
    [[nodiscard]] double slower() const noexcept { return slower_; }  // measured / predicted

private:
    static constexpr double kWorthNs = 50e3;
    double slower_ = 1.0;
};

}  // namespace tact
