// Rate of another process's counter over about the last second; a falling counter restarts the measurement.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

class CounterRate {
public:
    void add(std::int64_t at_ns, std::uint64_t count) {
        if (kept_ > 0 && (at_ns <= newest().at_ns || count < newest().count)) {
            if (at_ns == newest().at_ns && count == newest().count) return;
            kept_ = 0;
        }
        points_[next_] = {at_ns, count};
        next_ = (next_ + 1) % points_.size();
        kept_ = std::min(kept_ + 1, points_.size());
    }
    void clear() { kept_ = 0; }
    [[nodiscard]] bool known() const { return kept_ >= 2; }
    [[nodiscard]] double per_s() const {
        if (!known()) return 0.0;
        const Point& first = points_[(next_ + points_.size() - kept_) % points_.size()];
        return static_cast<double>(newest().count - first.count) /
               (1e-9 * static_cast<double>(newest().at_ns - first.at_ns));
    }

private:
    struct Point {
        std::int64_t at_ns = 0;
        std::uint64_t count = 0;
    };
    [[nodiscard]] const Point& newest() const {
        return points_[(next_ + points_.size() - 1) % points_.size()];
    }
    std::array<Point, 11> points_{};  // ten a second
    std::size_t next_ = 0, kept_ = 0;
};

}  // namespace tact
