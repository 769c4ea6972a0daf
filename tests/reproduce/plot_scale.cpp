#include "tests/reproduce/plot_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace tact::plot {

std::vector<double> ticks(Range range, int count_max) {
    const double length = range.high - range.low;
    if (!(length > 0.0) || !std::isfinite(length) || count_max < 2) return {range.low};
    // From too many to few enough; where the next coarser step leaves less than two, the finer one stays.
    std::vector<double> finer;
    double power = std::pow(10.0, std::floor(std::log10(length / count_max)) - 1.0);
    for (int tries = 0; tries < 4; ++tries) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double step = digit * power;
            const double first = std::ceil(range.low / step - 1e-9),
                         last = std::floor(range.high / step + 1e-9);
            if (last - first < 1.0) return finer.empty() ? std::vector<double>{range.low, range.high} : finer;
            if (!(last - first < 100.0)) continue;
            finer.clear();
            const int steps = static_cast<int>(std::lround(last - first));
            for (int k = 0; k <= steps; ++k) finer.push_back((first + k) * step + 0.0);  // never -0
            if (steps < count_max) return finer;
        }
        power *= 10.0;
    }
    return {range.low, range.high};
}

std::string tick_text(double value, double step) {
    const int decimals =
        step > 0.0 && step < 1.0 ? std::min(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 12) : 0;
    std::array<char, 64> text{};
    if (std::abs(value) >= 1e9 || decimals > 6) {
        std::snprintf(text.data(), text.size(), "%g", value);
        return text.data();
    }
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    std::string s = text.data();
    const std::size_t point = std::min(s.find('.'), s.size());
    const std::size_t first = s[0] == '-' ? 1 : 0;
    if (point - first >= 5)  // four digits read well as they are
        for (std::size_t i = point; i > first + 3;) s.insert(i -= 3, "\u202F");
    if (s[0] == '-') s.replace(0, 1, "\u2212");
    return s;
}

std::vector<std::vector<Point>> decimate(std::span<const Point> points, Range x, int columns) {
    std::vector<std::vector<Point>> pieces;
    const double per_column = (x.high - x.low) / std::max(columns, 1);
    const bool reduce =
        points.size() > 2 * static_cast<std::size_t>(std::max(columns, 1)) && per_column > 0.0;
    std::vector<Point> now;
    Point low{}, high{};
    double column = std::numeric_limits<double>::quiet_NaN();
    const auto flush = [&] {
        if (std::isnan(column)) return;
        const bool low_first = low.x <= high.x;
        now.push_back(low_first ? low : high);
        if (low.x != high.x || low.y != high.y) now.push_back(low_first ? high : low);
        column = std::numeric_limits<double>::quiet_NaN();
    };
    const auto end_piece = [&] {
        flush();
        if (!now.empty()) pieces.push_back(std::move(now));
        now.clear();
    };
    for (const Point& p : points) {
        if (!(std::isfinite(p.x) && std::isfinite(p.y))) {
            end_piece();
        } else if (!reduce) {
            now.push_back(p);
        } else {
            const double here = std::floor((p.x - x.low) / per_column);
            if (here != column) {
                flush();
                column = here;
                low = high = p;
            }
            if (p.y < low.y) low = p;
            if (p.y > high.y) high = p;
        }
    }
    end_piece();
    return pieces;
}

}  // namespace tact::plot
