// What fewer moves of the proxy would have cost and spared, from the steps of the last half second.
//
// Lag      after each number of moves, how far the proxy still was from where the step left it, in metres: the largest
//          of late, fading. Where a step used up its moves the true place is unknown: twice the way to the goal.
// Moves    what a step of late needed: the most, which fades, and the mean
// Thread   servo; no allocation
#pragma once

#include <algorithm>
#include <array>

#include "rt/force/surface/contact.hpp"

namespace tact {

class LagRecord {
public:
    static constexpr double kKept = 0.995;  // of the record, from step to step

    void add(const Contact& contact, double to_goal_m) noexcept TACT_RT {
        const bool short_of = contact.state == ContactState::lagging;
        const double needed = short_of ? SurfaceContact::kMovesMost : contact.moves;
        moves_ = std::max(kKept * moves_, needed);
        mean_ = 0.95 * mean_ + 0.05 * contact.moves;
        triangles_ = std::max(kKept * triangles_,
                              static_cast<double>(contact.triangles) / std::max(contact.moves, 1U));
        for (std::size_t m = 0; m < lag_m_.size(); ++m) {
            double lag_m = 0.0;
            if (m < contact.after_m.size()) lag_m = (contact.after_m[m] - contact.proxy_m).norm();
            // Out of moves, or of triangles, where no level has more.
            if (short_of && (m < contact.moves || contact.triangles >= SurfaceContact::kTrianglesMost))
                lag_m = 2.0 * to_goal_m;
            lag_m_[m] = std::max(kKept * lag_m_[m], lag_m);
        }
    }
    // Of steps with at most so many moves, at least 1.
    [[nodiscard]] double lag_m(std::uint32_t moves) const noexcept TACT_RT {
        return lag_m_[std::min<std::size_t>(moves, lag_m_.size()) - 1];
    }
    [[nodiscard]] double moves(std::uint32_t most) const noexcept TACT_RT {
        return std::clamp(moves_, 1.0, static_cast<double>(most));
    }
    [[nodiscard]] double mean_moves(std::uint32_t most) const noexcept TACT_RT {
        return std::clamp(mean_, 1.0, static_cast<double>(most));
    }
    [[nodiscard]] double triangles_per_move() const noexcept TACT_RT { return triangles_; }

private:
    std::array<double, SurfaceContact::kMovesMost> lag_m_{};
    double moves_ = 1.0, mean_ = 1.0, triangles_ = 0.0;
};

}  // namespace tact
