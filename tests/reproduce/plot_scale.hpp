// The arithmetic of a plot's axes and curves: round numbers, their texts, and fewer points with the same
// look.
//
// Pure functions; any thread; any numbers may come in.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tact::plot {

struct Point {
    double x = 0.0, y = 0.0;
};

struct Range {
    double low = 0.0, high = 1.0;
};

// Round numbers (1, 2, 5 times a power of ten) inside the range, at most count_max or five, at
// least two.
[[nodiscard]] std::vector<double> ticks(Range range, int count_max);
// With as many decimals as the step needs, thousands apart: "12 000", "0.25".
[[nodiscard]] std::string tick_text(double value, double step);

// At most two points a column and curve piece, in order of x: the lowest and the highest in it, at their
// place. Pieces end where a value is not finite; columns are of equal width over the range.
[[nodiscard]] std::vector<std::vector<Point>> decimate(std::span<const Point> points, Range x, int columns);

}  // namespace tact::plot
