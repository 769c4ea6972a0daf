// Purpose: number of 20 random starts, 15 Å and 30 degrees away, from which full-gradient ascent reaches the known
// position (2026-11-20):
//     force map resolution  full     6 Å   10 Å   14 Å   18 Å
//     3MFP in EMD-5168         6        10    13     16     17
//     1J6Z in EMD-5168         2         8    14     16      0 (displaced by 1.8 Å)
//     EMD-5778, one chain     17        20    20     20     20
//     EMD-5925, one chain      9        20    20     20     20
// Separable: three passes over lines; each line is copied to a contiguous buffer, so the stride does not matter.
#include "prep/map/low_pass.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kSigmaPerResolution = 0.225;
constexpr double kCutSigma = 4.0;

std::vector<double> half_kernel(double sigma_voxels) {
    const auto radius = static_cast<std::size_t>(std::ceil(kCutSigma * sigma_voxels));
    std::vector<double> k(radius + 1);
    double sum = 0.0;
    for (std::size_t i = 0; i <= radius; ++i) {
        const double d = static_cast<double>(i) / sigma_voxels;
        k[i] = std::exp(-0.5 * d * d);
        sum += i == 0 ? k[i] : 2.0 * k[i];
    }
    for (double& w : k) w /= sum;
    return k;
}

}  // namespace

DensityGrid low_pass(const DensityGrid& grid, double background, double resolution_m,
                     const Progress& progress) {
    DensityGrid out = grid;
    std::array<std::size_t, 3> stride{1, grid.size[0], std::size_t{grid.size[0]} * grid.size[1]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t n = grid.size[axis], u = (axis + 1) % 3, v = (axis + 2) % 3;
        const std::vector<double> kernel =
            half_kernel(kSigmaPerResolution * resolution_m / grid.spacing_m[static_cast<Eigen::Index>(axis)]);
        const std::size_t radius = kernel.size() - 1;
        std::vector<double> line(n + 2 * radius, background);
        for (std::size_t j = 0; j < grid.size[v]; ++j) {
            report(progress, (static_cast<double>(axis) + static_cast<double>(j) / grid.size[v]) / 3.0,
                   "smoothing the force map");
            for (std::size_t i = 0; i < grid.size[u]; ++i) {
                float* const first = out.values.data() + i * stride[u] + j * stride[v];
                for (std::size_t x = 0; x < n; ++x)
                    line[radius + x] = static_cast<double>(first[x * stride[axis]]);
                for (std::size_t x = 0; x < n; ++x) {
                    const double* const here = line.data() + radius + x;
                    double sum = kernel[0] * here[0];
                    for (std::size_t r = 1; r <= radius; ++r) sum += kernel[r] * (here[r] + *(here - r));
                    first[x * stride[axis]] = static_cast<float>(sum);
                }
            }
        }
    }
    return out;
}

}  // namespace tact
