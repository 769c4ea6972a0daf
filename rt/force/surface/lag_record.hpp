// Moves that recent steps needed, and the levels that would have lagged in them (about half a second at 1 kHz).
//
// Lagged   for each maximum number of moves: 1 if a step limited to it would have ended elsewhere by more than a margin,
//          fading after the last such step. If a step used up its moves, more moves are assumed to suffice; if it used
//          up its triangles, no number does.
// Moves    that recent steps needed: the maximum, fading, and the mean
// Thread   servo; no allocation
#pragma once

#include <algorithm>
#include <array>

#include "rt/force/surface/contact.hpp"

namespace tact {

class LagRecord {
public:
    static constexpr double kKept = 0.995;  // of the record, from step to step

    void add(const Contact& contact, double margin_m) noexcept TACT_RT {
        const bool short_of = contact.state == ContactState::lagging,
                   all = short_of && contact.triangles >= SurfaceContact::kTrianglesMost;
        const double needed = short_of ? SurfaceContact::kMovesMost : contact.moves;
        moves_ = std::max(kKept * moves_, needed);
        mean_ = 0.95 * mean_ + 0.05 * contact.moves;
        triangles_ = std::max(kKept * triangles_,
                              static_cast<double>(contact.triangles) / std::max(contact.moves, 1U));
        if (!short_of && contact.after_m.empty()) {  // most steps: the record only fades
            for (double& lagged : lagged_) lagged *= kKept;
            return;
        }
        double least = 0.0;  // a level below one that lags lags too
        for (std::size_t m = lagged_.size(); m-- > 0;) {
            bool lagged = all || (short_of && m < contact.moves);
            if (m < contact.after_m.size())
                lagged |= (contact.after_m[m] - contact.proxy_m).norm() > margin_m;
            lagged_[m] = std::max({kKept * lagged_[m], lagged ? 1.0 : 0.0, least});
            least = lagged_[m];
        }
    }
    // At a maximum of `moves`, at least 1.
    [[nodiscard]] double lagged(std::uint32_t moves) const noexcept TACT_RT {
        return lagged_[std::min<std::size_t>(moves, lagged_.size()) - 1];
    }
    [[nodiscard]] double moves(std::uint32_t most) const noexcept TACT_RT {
        return std::clamp(moves_, 1.0, static_cast<double>(most));
    }
    [[nodiscard]] double mean_moves(std::uint32_t most) const noexcept TACT_RT {
        return std::clamp(mean_, 1.0, static_cast<double>(most));
    }
    [[nodiscard]] double triangles_per_move() const noexcept TACT_RT { return triangles_; }

private:
    std::array<double, SurfaceContact::kMovesMost> lagged_{};
    double moves_ = 1.0, mean_ = 1.0, triangles_ = 0.0;
};

}  // namespace tact
