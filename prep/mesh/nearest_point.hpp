// The point of a triangle nearest to a given point, by Voronoi region (Ericson, Real-Time Collision Detection, 5.1.5).
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace tact {

struct NearestPoint {
    double square = 1e300;                // squared distance
    std::array<double, 3> part{0, 0, 0};  // barycentric coordinates
};

inline NearestPoint nearest_point(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
                 d6 = ac.dot(cp);
    const auto at = [&](double on_b, double on_c) -> NearestPoint {
        return {(ap - on_b * ab - on_c * ac).squaredNorm(), {1.0 - on_b - on_c, on_b, on_c}};
    };
    if (d1 <= 0 && d2 <= 0) return at(0, 0);
    if (d3 >= 0 && d4 <= d3) return at(1, 0);
    if (d6 >= 0 && d5 <= d6) return at(0, 1);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - s, s);
    }
    const double sum = va + vb + vc;
    return at(vb / sum, vc / sum);
}

}  // namespace tact
