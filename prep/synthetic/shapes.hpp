// Solid shapes as signed distances (negative inside), for synthetic volumes.
//
// Distances are exact or less than the true ones, so a cube can be skipped if the distance at its middle is more than
// half its diagonal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact::shape {

// A bar with round ends whose radius changes linearly from a to b.
struct Bar {
    Vec3 a, b;
    double radius_a, radius_b;
    [[nodiscard]] double distance(const Vec3& p) const {
        const Vec3 ab = b - a;
        const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        return (p - a - t * ab).norm() - (radius_a + t * (radius_b - radius_a));
    }
};

// Bars along a smooth curve through all points (Catmull-Rom spline).
inline std::vector<Bar> tube(std::span<const Vec3> through, double radius, int parts = 6) {
    std::vector<Bar> bars;
    const auto n = static_cast<std::ptrdiff_t>(through.size());
    const auto at = [&](std::ptrdiff_t i) {
        return through[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
    };
    Vec3 last = through[0];
    for (std::ptrdiff_t i = 0; i + 1 < n; ++i) {
        for (int k = 1; k <= parts; ++k) {
            const double t = static_cast<double>(k) / parts, t2 = t * t, t3 = t2 * t;
            const Vec3 next = 0.5 * (2.0 * at(i) + t * (at(i + 1) - at(i - 1)) +
                                     t2 * (2.0 * at(i - 1) - 5.0 * at(i) + 4.0 * at(i + 1) - at(i + 2)) +
                                     t3 * (3.0 * at(i) - at(i - 1) - 3.0 * at(i + 1) + at(i + 2)));
            bars.push_back({last, next, radius, radius});
            last = next;
        }
    }
    return bars;
}

inline double nearest(std::span<const Bar> bars, const Vec3& p) {
    double d = 1e9;
    for (const Bar& bar : bars) d = std::min(d, bar.distance(p));
    return d;
}

// Union: the smaller of two distances, rounded where they differ by less than k.
inline double join(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - 0.25 * h * h * k;
}

}  // namespace tact::shape
