// With d = map - background and s the simulated map, the scale is sum(d s) / sum(s s) over the region; the
// explained fraction of d is sum(d s)^2 / (sum(s s) sum(d d)). The fit has no free offset, which would also
// explain the tails of adjacent structures: the background is known.
#include "ipc/scene/density/subtracted_map.hpp"

#include <algorithm>

namespace tact {

namespace {

constexpr float kRegionShare = 0.05F;

}  // namespace

SubtractedMap subtract_placed(const DensityGrid& grid, double background,
                              std::span<const PlacedStructure> placed, double resolution_m) {
    SubtractedMap out;
    out.grid = grid;
    const std::vector<float> simulated = simulated_map(grid, placed, resolution_m);
    const float most = simulated.empty() ? 0.0F : *std::max_element(simulated.begin(), simulated.end());
    if (!(most > 0.0F) || grid.values.size() != simulated.size()) return out;
    double ds = 0.0, ss = 0.0, dd = 0.0;
    for (std::size_t i = 0; i < simulated.size(); ++i) {
        if (!(simulated[i] > kRegionShare * most)) continue;
        const double d = static_cast<double>(grid.values[i]) - background,
                     s = static_cast<double>(simulated[i]);
        ds += d * s, ss += s * s, dd += d * d;
        ++out.region_voxels;
    }
    out.scale = std::max(0.0, ds / ss);
    out.explained = dd > 0.0 && ds > 0.0 ? ds * ds / (ss * dd) : 0.0;
    const auto scale = static_cast<float>(out.scale), floor = static_cast<float>(background);
    for (std::size_t i = 0; i < simulated.size(); ++i) {
        float& v = out.grid.values[i];
        v = std::max(v - scale * simulated[i], std::min(v, floor));
    }
    return out;
}

}  // namespace tact
