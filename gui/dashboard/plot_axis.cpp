#include "gui/dashboard/plot_axis.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

Axis linear_axis(double high, int marks_max) {
    Axis axis;
    if (!(high > 0.0) || !std::isfinite(high)) high = 1.0;
    const double rough = high / std::max(marks_max, 1);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10.0 * power;
    for (const double s : {1.0, 2.0, 5.0})
        if (s * power >= rough * (1.0 - 1e-9)) {
            step = s * power;
            break;
        }
    axis.high = step * std::ceil(high / step - 1e-9);
    for (int i = 0; i * step <= axis.high * (1.0 + 1e-9); ++i) axis.mark.push_back(i * step);
    return axis;
}

Axis range_axis(double low, double high, int marks_max) {
    if (!std::isfinite(low) || !std::isfinite(high) || high < low) low = 0.0, high = 1.0;
    const double size = std::max(std::fabs(low), std::fabs(high));
    if (high - low < 1e-6 * size || size == 0.0) {
        const double half = size > 0.0 ? 0.05 * size : 1.0;
        low -= half;
        high += half;
    }
    const Axis steps = linear_axis(high - low, marks_max);
    const double step = steps.mark[1];
    Axis axis;
    const double first = std::floor(low / step + 1e-9),
                 last = std::max(std::ceil(high / step - 1e-9), first + 1.0);
    axis.low = first * step;
    axis.high = last * step;
    for (double i = first; i <= last + 0.5; i += 1.0) axis.mark.push_back(i * step);
    return axis;
}

Axis log_axis(double low, double high) {
    Axis axis;
    if (!(low > 0.0) || !std::isfinite(low)) low = 1.0;
    if (!(high > low) || !std::isfinite(high)) high = 10.0 * low;
    const double first = std::floor(std::log10(low) + 1e-9);
    const double last = std::max(std::ceil(std::log10(high) - 1e-9), first + 1.0);
    axis.low = std::pow(10.0, first);
    axis.high = std::pow(10.0, last);
    for (double e = first; e <= last + 0.5; e += 1.0) axis.mark.push_back(std::pow(10.0, e));
    return axis;
}

double axis_top(std::vector<float>& values) {
    if (values.empty()) return 0.0;
    const double most = static_cast<double>(*std::max_element(values.begin(), values.end()));
    if (values.size() < kFewestForPercentile) return most;
    const auto at = static_cast<std::ptrdiff_t>(kAxisPercentile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    const double usual = static_cast<double>(values[static_cast<std::size_t>(at)]);
    return most > kClippedFrom * usual ? usual : most;
}

}  // namespace tact
