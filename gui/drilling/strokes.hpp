// Strokes of a cutting burr: the path from one turning point to the next, or until it cuts nothing for a while.
//
// Method   a turning point is the point farthest from the stroke's beginning, once the burr has come kBackM closer
//          again. Strokes shorter than kLeastM do not count.
// Unit     metres of the hand's space, seconds
// Thread   one; no allocation
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

struct StrokeMetrics {
    std::uint64_t count = 0;
    double length_m = 0.0, time_s = 0.0;  // totals; straight from turning point to turning point
    [[nodiscard]] double mean_length_m() const {
        return count > 0 ? length_m / static_cast<double>(count) : 0.0;
    }
    [[nodiscard]] double mean_speed_m_s() const { return time_s > 0.0 ? length_m / time_s : 0.0; }
};

class Strokes {
public:
    static constexpr double kBackM = 5e-4, kLeastM = 1e-3, kPauseS = 0.15;

    // Position of the burr in every cycle; cuts: bone was removed.
    void step(double t_s, const Vec3& at_m, bool cuts);
    // Includes the stroke in progress.
    [[nodiscard]] StrokeMetrics metrics() const;

private:
    struct Point {
        double t_s = 0.0;
        Vec3 at_m = Vec3::Zero();
    };
    void end_at(const Point& to, StrokeMetrics& metrics) const;

    StrokeMetrics done_;
    bool under_way_ = false;
    Point from_, farthest_;
    double far_m_ = 0.0, cut_s_ = 0.0;
};

}  // namespace tact
