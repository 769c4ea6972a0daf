// The most recent durations of an activity, and their percentiles. Not for the servo path: a query copies.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tact {

class RecentTimes {
public:
    explicit RecentTimes(std::size_t most) : most_(most) { time_s_.reserve(most); }
    void add(double s) {
        const auto value = static_cast<float>(s);
        if (time_s_.size() < most_)
            time_s_.push_back(value);
        else
            time_s_[next_] = value;
        next_ = (next_ + 1) % most_;
    }
    [[nodiscard]] std::size_t size() const noexcept { return time_s_.size(); }
    // The nearest recorded value, p in [0, 1]; 0 without one.
    [[nodiscard]] float percentile_s(double p) const {
        if (time_s_.empty()) return 0.0F;
        std::vector<float> sorted = time_s_;
        const auto rank = static_cast<std::ptrdiff_t>(
            std::ceil(std::clamp(p, 0.0, 1.0) * static_cast<double>(sorted.size() - 1)));
        std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
        return sorted[static_cast<std::size_t>(rank)];
    }
    [[nodiscard]] float most_s() const { return percentile_s(1.0); }

private:
    std::size_t most_, next_ = 0;
    std::vector<float> time_s_;
};

}  // namespace tact
