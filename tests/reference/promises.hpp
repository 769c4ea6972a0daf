// Promises of a force model, counted against an independent reference.
//
// Ratio    measured over allowed; above 1 is a violation. A value that is not finite is one too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace tact::reference {

struct Promise {
    Promise(std::string called, std::string means) : name(std::move(called)), meaning(std::move(means)) {}

    std::string name, meaning;
    std::uint64_t steps = 0, violations = 0;
    double worst_ratio = 0.0;
    std::string worst_at;  // the pose of the worst ratio, for the report

    // True: a new worst one; the caller may then describe it in worst_at.
    bool check(double measured, double allowed) {
        ++steps;
        const double ratio = measured <= 0.0 ? 0.0 : measured / allowed;
        const bool kept = ratio <= 1.0;  // false for NaN
        if (!kept) ++violations;
        const double known = std::isfinite(ratio) ? ratio : 1e300;
        if (known <= worst_ratio) return false;
        worst_ratio = known;
        return true;
    }
};

// References stay valid as promises are added.
using Promises = std::deque<Promise>;

}  // namespace tact::reference
