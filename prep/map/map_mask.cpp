#include "prep/map/map_mask.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/scene/fit/fit_sums.hpp"

namespace tact {
namespace {

constexpr float kOvershoot = 0.1F;  // of soft edges that another program interpolated
constexpr double kSameVoxels = 0.01;

}  // namespace

bool same_grid(const DensityGrid& a, const DensityGrid& b) {
    if (a.size != b.size) return false;
    for (int i = 0; i < 3; ++i) {
        const double near_m = kSameVoxels * a.spacing_m[i];
        const auto n = static_cast<double>(a.size[static_cast<std::size_t>(i)]);
        // Also at the far end of the box, where a difference of the spacing adds up.
        if (!(std::abs(a.origin_m[i] - b.origin_m[i]) <= near_m) ||
            !(n * std::abs(a.spacing_m[i] - b.spacing_m[i]) <= near_m))
            return false;
    }
    return true;
}

DensityGrid mask_on(const DensityGrid& grid, const DensityGrid& mask, const std::string& name) {
    const auto refuse = [&](const std::string& why, const char* fix) {
        throw StartupError("use the mask " + name, why, fix);
    };
    const auto [low, high] = std::minmax_element(mask.values.begin(), mask.values.end());
    if (*low < -kOvershoot || *high > 1.0F + kOvershoot) {
        refuse(printed("its values go from %g to %g", static_cast<double>(*low), static_cast<double>(*high)),
               "a mask is 1 inside and 0 outside; scale it, or check that it is no density map");
    }
    DensityGrid out = grid;
    const bool same = same_grid(grid, mask);
    std::size_t i = 0, inside = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z)
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++i) {
                const Vec3 p_m = grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z));
                const double value =
                    same ? static_cast<double>(mask.values[i])
                         : map_at(mask, (p_m - mask.origin_m).cwiseQuotient(mask.spacing_m), 0.0);
                out.values[i] = static_cast<float>(std::clamp(value, 0.0, 1.0));
                if (out.values[i] > 0.0F) ++inside;
            }
    if (inside == 0)
        refuse("nothing of the map lies inside it",
               "check that mask and map have the same origin and voxel size");
    if (share_inside(out) == 1.0)
        refuse("all of the map lies inside it", "leave it out, or check that it is the mask of this map");
    return out;
}

void apply_mask(DensityGrid& grid, const DensityGrid& mask, double background) {
    const auto b = static_cast<float>(background);
    for (std::size_t i = 0; i < grid.values.size(); ++i)
        grid.values[i] = b + mask.values[i] * (grid.values[i] - b);
}

double share_inside(const DensityGrid& mask) {
    const auto inside =
        std::count_if(mask.values.begin(), mask.values.end(), [](float v) { return v > 0.5F; });
    return static_cast<double>(inside) / static_cast<double>(mask.values.size());
}

}  // namespace tact
