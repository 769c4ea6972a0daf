// Weighted points of a body, stored in an order that is fast to sum.
//
// Frame    body, metres. Weights sum to 1.
// Order    along a Morton curve, so that consecutive points share cache lines of the map. The sum does not
//          depend on the order beyond single-precision rounding.
// Fails by StartupError: no points, points that are not finite or farther out than a millimetre, invalid weights.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

struct PointSet {
    std::vector<float> x_m, y_m, z_m, weight;
    std::vector<std::uint32_t> source;  // index of each point in the order that it was given
    double radius_m = 0.0;              // distance of the farthest point from the origin

    [[nodiscard]] std::size_t size() const { return x_m.size(); }
    [[nodiscard]] PointsView view() const { return {x_m, y_m, z_m, weight}; }
    [[nodiscard]] PointsView view(std::size_t begin, std::size_t count) const {
        const PointsView all = view();
        return {all.x.subspan(begin, count), all.y.subspan(begin, count), all.z.subspan(begin, count),
                all.weight.subspan(begin, count)};
    }
};

// name: of the structure, for error messages.
PointSet make_point_set(const PointsView& points, const std::string& name);

}  // namespace tact
