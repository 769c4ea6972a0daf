// Percentiles of the values measured in one pass. The unit is the caller's.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tact {

struct Percentiles {
    double p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
};

// The ceil(p n)-th smallest value; 0 for an empty vector. p in (0, 1].
[[nodiscard]] inline double percentile(std::vector<double> values, double p) {
    if (values.empty()) return 0.0;
    const double rank = std::ceil(p * static_cast<double>(values.size()) * (1.0 - 0x1p-50));
    const auto at =
        static_cast<std::ptrdiff_t>(std::clamp(rank, 1.0, static_cast<double>(values.size()))) - 1;
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

[[nodiscard]] inline Percentiles percentiles(const std::vector<double>& values) {
    return {percentile(values, 0.5), percentile(values, 0.99), percentile(values, 0.999),
            percentile(values, 1.0)};
}

}  // namespace tact
