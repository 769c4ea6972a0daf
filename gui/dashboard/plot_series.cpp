#include "gui/dashboard/plot_series.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

PlotSeries::PlotSeries() : bins_(kLevels * kBins) {}

double PlotSeries::width_s(std::size_t level) {
    return kFinest_s * std::pow(static_cast<double>(kFactor), static_cast<double>(level));
}

void PlotSeries::clear() {
    std::fill(bins_.begin(), bins_.end(), Bin{});
    last_t_s_ = -1.0;
}

void PlotSeries::add(double t_s, double value) {
    if (!std::isfinite(value) || !(t_s >= std::max(last_t_s_, 0.0)) || t_s > 1e9) return;
    const auto v = static_cast<float>(value);
    if (!std::isfinite(v)) return;
    last_t_s_ = t_s;
    last_ = v;
    auto number = static_cast<std::int64_t>(t_s / kFinest_s);
    for (std::size_t level = 0; level < kLevels; ++level, number /= static_cast<std::int64_t>(kFactor)) {
        Bin& bin = bins_[level * kBins + static_cast<std::size_t>(number) % kBins];
        if (bin.number == number) {
            bin.low = std::min(bin.low, v);
            bin.high = std::max(bin.high, v);
        } else {
            bin = {number, v, v};
        }
    }
}

void PlotSeries::window(double begin_s, double end_s, std::vector<PlotBin>& out) const {
    out.clear();
    if (empty() || !(end_s > begin_s)) return;
    begin_s = std::max(begin_s, 0.0);
    end_s = std::min(end_s, last_t_s_ + kFinest_s);
    std::size_t level = 0;
    while (level + 1 < kLevels && (end_s - begin_s) / width_s(level) > static_cast<double>(kBins - 2))
        ++level;
    const double width = width_s(level);
    const auto last = static_cast<std::int64_t>(end_s / width);
    const auto first =
        std::max(static_cast<std::int64_t>(begin_s / width), last - static_cast<std::int64_t>(kBins) + 1);
    for (std::int64_t number = first; number <= last; ++number) {
        const Bin& bin = bins_[level * kBins + static_cast<std::size_t>(number) % kBins];
        if (bin.number == number)
            out.push_back({static_cast<double>(number) * width, width, bin.low, bin.high});
    }
}

}  // namespace tact
