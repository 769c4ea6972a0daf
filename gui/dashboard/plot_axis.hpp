// Ranges of the axes of plots and their tick marks.
#pragma once

#include <cstddef>
#include <vector>

namespace tact {

struct Axis {
    double low = 0.0, high = 1.0;
    std::vector<double> mark;
};
[[nodiscard]] Axis linear_axis(double high, int marks_max);
// For an axis that need not end at 0: whole steps around [low, high], or around the middle if both are equal.
[[nodiscard]] Axis range_axis(double low, double high, int marks_max);
[[nodiscard]] Axis log_axis(double low, double high);

// Up to where an axis shows values that are mostly small: to the percentile kAxisPercentile if the largest value exceeds
// kClippedFrom times that, so that one slow frame does not flatten all others; else to the largest one. Too few values
// are all shown. Reorders the values.
inline constexpr double kAxisPercentile = 0.98, kClippedFrom = 1.5;
inline constexpr std::size_t kFewestForPercentile = 8;
[[nodiscard]] double axis_top(std::vector<float>& values);

}  // namespace tact
