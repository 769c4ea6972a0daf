// The synthetic ring of six, and settings of a search in it.
#pragma once

#include <cmath>

#include "ipc/base/units.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/search/search.hpp"
#include "prep/synthetic/ring.hpp"

namespace tact::search_test {

inline const SyntheticRing& ring() {
    static const SyntheticRing made = make_ring();
    return made;
}

inline double rmsd_a(const Structure& s, const Pose& a, const Pose& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                      static_cast<double>(s.z_m[i]));
        sum += ((a.p_m + a.q * at) - (b.p_m + b.q * at)).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(s.size())) / kAngstromM;
}

inline SearchSettings settings() {
    const MapStatistics statistics = map_statistics(ring().grid);
    return {.resolution_m = ring().resolution_m,
            .background = statistics.background,
            .rotations_max = 1500,
            .threads = 2};
}

// Of a subunit: the ring has six of each, turned about its axis.
inline Pose place_in_ring(const Structure& s, std::size_t turns) {
    const Quat turn(Eigen::AngleAxisd(static_cast<double>(turns) * std::numbers::pi / 3.0, Vec3::UnitZ()));
    return {turn * s.home_com_model_m, turn};
}

}  // namespace tact::search_test
