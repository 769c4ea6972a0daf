#include "prep/map/map_resolution.hpp"

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"

namespace tact {

void check_resolution(double resolution_m, const std::string& option) {
    if (resolution_m >= 0.5 * kAngstromM && resolution_m <= 200.0 * kAngstromM) return;
    throw StartupError("use the resolution",
                       printed("%g Å is outside 0.5 to 200 Å", resolution_m / kAngstromM),
                       "give it in ångström: " + option + " 10");
}

void refuse_unknown_resolution(const std::string& map, const Vec3& voxel_m) {
    const double voxel_a = voxel_m.maxCoeff() / kAngstromM;
    throw StartupError(
        "use the map " + map, "its resolution is unknown",
        printed(
            "give it as published: --resolution-a A; with voxels of %.2f Å it is probably between %.1f and "
            "%.1f; or give its half-maps: --half-map FILE, twice",
            voxel_a, 2.0 * voxel_a, 5.0 * voxel_a));
}

}  // namespace tact
