#include "prep/synthetic/two_rings.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace tact {

DensityGrid two_rings_map() {
    constexpr std::uint32_t kSide = 73;
    constexpr double kWidthM = 0.0768;
    std::vector<Vec3> blob;
    for (int ring = 0; ring < 2; ++ring) {
        for (int k = 0; k < 7; ++k) {
            for (int l = 0; l < 3; ++l) {
                const double angle = 2.0 * std::numbers::pi * (k + 0.5 * ring) / 7.0 + 0.1 * l;
                const double radius_m = 0.4 + 0.11 * std::sin(2.1 * l);
                blob.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle),
                                  (ring == 1 ? 1.0 : -1.0) * (0.12 + 0.17 * l));
            }
        }
    }
    DensityGrid grid;
    grid.size = {kSide, kSide, kSide};
    grid.origin_m = Vec3::Constant(-1.0);
    grid.spacing_m = Vec3::Constant(2.0 / (kSide - 1));
    grid.values.reserve(grid.count());
    for (std::uint32_t z = 0; z < kSide; ++z) {
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const Vec3 p = grid.origin_m + grid.spacing_m.cwiseProduct(Vec3(x, y, z));
                double sum = 0.0;
                for (const Vec3& b : blob)
                    sum += std::exp(-(p - b).squaredNorm() / (2.0 * kWidthM * kWidthM));
                grid.values.push_back(static_cast<float>(sum));
            }
        }
    }
    return grid;
}

}  // namespace tact
