#include "gui/docking/body_pick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact {

std::optional<std::size_t> body_along(const Sight& sight, std::span<const ShownBody> bodies,
                                      const std::vector<Structure>& structures) {
    std::optional<std::size_t> first;
    double least_m = std::numeric_limits<double>::max();
    const double way_squared = sight.way.squaredNorm();
    if (!(way_squared > 0.0)) return first;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const ShownBody& body = bodies[i];
        if (body.hidden || body.structure >= structures.size()) continue;
        const Structure& atoms = structures[body.structure];
        const Quat back = body.T_model_body.q.conjugate();
        const Vec3 from_m = back * (sight.from_m - body.T_model_body.p_m), way = back * sight.way;
        for (std::size_t a = 0; a < atoms.size(); ++a) {
            const Vec3 to_m(static_cast<double>(atoms.x_m[a]) - from_m.x(),
                            static_cast<double>(atoms.y_m[a]) - from_m.y(),
                            static_cast<double>(atoms.z_m[a]) - from_m.z());
            const double depth_m = to_m.dot(way) / way_squared;
            if (!(depth_m > sight.near_m) || depth_m >= least_m) continue;
            const double radius_m = std::max(kPickRadiusM, kPickPx * sight.px_share * depth_m);
            if ((to_m - depth_m * way).squaredNorm() > radius_m * radius_m) continue;
            least_m = depth_m;
            first = i;
        }
    }
    return first;
}

}  // namespace tact
