// Elasticity of a path's cost with respect to its level: d ln(cost) / d ln(level).
//
// Model     cost = fixed + rate * level; least squares over the measurements, with decaying weights
// Prior     half of the cost is fixed. While the level does not move, the prior decides; it weighs as much as
//           measurements whose levels have a relative spread of kPriorSpread
// Bounded   the elasticity lies in [kLeast, 1] for any input; impossible costs and levels are ignored
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/rt.hpp"

namespace tact {

class CostFit {
public:
    static constexpr double kLeast = 0.05;
    static constexpr double kPriorSpread = 0.1;
    static constexpr double kMemory = 200.0;  // measurements

    void add(double level, double cost_s) noexcept TACT_RT {
        if (!(level > 0.0 && level <= 1.0 && cost_s > 0.0 && cost_s < 1e3)) return;
        n_ = std::min(n_ + 1.0, kMemory);
        const double a = 1.0 / n_, dl = level - level_, dc = cost_s - cost_;
        level_ += a * dl;
        cost_ += a * dc;
        var_ += a * ((1.0 - a) * dl * dl - var_);
        cov_ += a * ((1.0 - a) * dl * dc - cov_);
    }
    [[nodiscard]] double elasticity(double level) const noexcept TACT_RT {
        if (n_ < 1.0 || cost_ <= 0.0) return 0.5;
        const double prior_slope = 0.5 * cost_ / level_, w = kPriorSpread * kPriorSpread * level_ * level_;
        const double slope = (cov_ + w * prior_slope) / (var_ + w);
        const double cost = cost_ + slope * (level - level_);
        if (!(cost > 0.0)) return 1.0;
        return std::clamp(slope * level / cost, kLeast, 1.0);
    }
    [[nodiscard]] double cost_s() const noexcept TACT_RT { return cost_; }

private:
    double n_ = 0.0, level_ = 0.0, cost_ = 0.0, var_ = 0.0, cov_ = 0.0;
};

}  // namespace tact
