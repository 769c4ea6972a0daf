// What a query found of sixteen triangles, kept for later moves of the same point.
//
// Bound     A ball whose centre has moved by s since is at least the least distance minus s from all of them.
// Free      The distance of a triangle is a convex function of the centre, so its value and slope at the place of the query bound
//           it anywhere from below, as does its plane. Where one of the two bounds keeps the ball off at both ends of a straight
//           displacement, it does so along its whole length.
// Unit      metres of the model.  Thread  servo; no allocation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/triangle_query.hpp"

namespace tact {

struct SeenTriangles {
    TriangleQueries seen;
    Vec3 place_m = Vec3::Zero();  // of the query
    double least_m = -1.0;        // least distance there; negative: not queried yet

    // Lower bounds for a centre that goes from one place to another: of the distance at the first, and along the whole way.
    struct Clearance {
        double begin_m = 0.0, way_m = 0.0;
    };

    // A bound by the least distance alone, for both; negative if nothing is known.
    [[nodiscard]] double coarse_m(const Vec3& at_m) const noexcept TACT_RT {
        return least_m < 0.0 ? -1.0 : least_m - (at_m - place_m).norm();
    }
    // Only if queried.
    [[nodiscard]] Clearance clearance_m(const Vec3& begin_m, const Vec3& end_m) const noexcept TACT_RT {
        const Eigen::Vector3f a = (begin_m - place_m).cast<float>(), b = (end_m - place_m).cast<float>();
        const float ax = a.x(), ay = a.y(), az = a.z(), bx = b.x(), by = b.y(), bz = b.z();
        float begin[kLooks], way[kLooks];
        for (std::size_t i = 0; i < kLooks; ++i) {
            const float near_a = seen.distance[i] + seen.away[0][i] * ax + seen.away[1][i] * ay +
                                 seen.away[2][i] * az,
                        near_b = seen.distance[i] + seen.away[0][i] * bx + seen.away[1][i] * by +
                                 seen.away[2][i] * bz,
                        over_a = seen.height[i] + seen.facet[0][i] * ax + seen.facet[1][i] * ay +
                                 seen.facet[2][i] * az,
                        over_b = seen.height[i] + seen.facet[0][i] * bx + seen.facet[1][i] * by +
                                 seen.facet[2][i] * bz;
            const float near = near_b < near_a ? near_b : near_a, over = over_b < over_a ? over_b : over_a;
            begin[i] = over_a > near_a ? over_a : near_a;
            way[i] = over > near ? over : near;
        }
        for (std::size_t width = kLooks / 2; width > 0; width /= 2)
            for (std::size_t i = 0; i < width; ++i) {
                begin[i] = begin[i + width] < begin[i] ? begin[i + width] : begin[i];
                way[i] = way[i + width] < way[i] ? way[i + width] : way[i];
            }
        // Single precision of the terms.
        const double rounding =
            1e-6 * (least_m + std::max(static_cast<double>(a.norm()), static_cast<double>(b.norm())));
        return {static_cast<double>(begin[0]) - rounding, static_cast<double>(way[0]) - rounding};
    }
};

}  // namespace tact
