#include "gui/drilling/first_bone.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {
constexpr double kLineStep = 0.5;         // voxels
constexpr std::uint8_t kSolidHalf = 128;  // density
}  // namespace

std::optional<Vec3> first_bone(const BoneVolumeView& volume, const Vec3& from_m, const Vec3& way) {
    const BoneBricks& b = volume.bricks;
    if (!from_m.allFinite() || !way.allFinite() || !(way.norm() > 0.0)) return std::nullopt;
    const Vec3 from = b.to_voxels(from_m), along = way.normalized();
    // The part of the line inside the volume.
    double begin = 0.0, end = 1e9;
    for (int k = 0; k < 3; ++k) {
        const double low = -0.5 - from[k], high = b.size[static_cast<std::size_t>(k)] - 0.5 - from[k];
        if (std::abs(along[k]) < 1e-12) {
            if (low > 0.0 || high < 0.0) return std::nullopt;
            continue;
        }
        const double t0 = low / along[k], t1 = high / along[k];
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    const double length = std::clamp(end - begin, 0.0, 1e6);  // no volume is as long
    const int steps = static_cast<int>(length / kLineStep);
    for (int i = 0; i <= steps; ++i) {
        const double t = begin + (i + 0.5) * kLineStep;
        if (t >= end) break;
        const Vec3 at = from + t * along;
        std::array<std::uint32_t, 3> voxel{};
        for (int k = 0; k < 3; ++k) {
            const auto most = static_cast<double>(b.size[static_cast<std::size_t>(k)] - 1U);
            voxel[static_cast<std::size_t>(k)] =
                static_cast<std::uint32_t>(std::clamp(std::round(at[k]), 0.0, most));
        }
        if (volume.at(voxel[0], voxel[1], voxel[2]) >= kSolidHalf) return b.to_model(at);
    }
    return std::nullopt;
}

}  // namespace tact
