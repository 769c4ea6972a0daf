// Contour-based docking (Chacon, Wriggers 2002, J. Mol. Biol. 317:375) correlates the Laplacians of both
// maps,
//     C = integral L[rho_em] L[rho_calc],   rho_calc = sum_i w_i G(x - x_i)  (G: Gaussian of the resolution).
// The plain reduced correlation, with G a delta, is sum_i w_i rho_em(x_i). The Laplacian is symmetric
// (integration by parts, zero at infinity), so both operators can be applied to the fixed map:
//     integral L[rho_em] L[G_i] = (L L G * rho_em)(x_i),
//     integral grad rho_em . grad G_i = (-L G * rho_em)(x_i).
// Both are fields sampled at points, energies like the density itself. This code uses the second, the
// correlation of gradients, which weighs a wave of the map by k^2. The first weighs it by k^4, and its
// basins are narrower: of ten starts 15 A and 30 degrees away in the simulated 1OEL it found 2, the second
// 9 (10 A), and it was not better in the experimental maps (docking_finds, 2026-11-21).
//
// Separable: L = Gxx Gy Gz + Gx Gyy Gz + Gx Gy Gzz, in seven passes over lines. The tables are samples of a
// Gaussian and of its second derivative, cut at five sigma, the first scaled to sum 1, the second to sum 0
// and second moment 2, so polynomials up to the third degree are filtered exactly at any sigma.
#include "ipc/scene/density/laplacian_map.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/simulated_map.hpp"

namespace tact {

namespace {

constexpr double kCutSigmas = 5.0;
constexpr double kSigmaVoxelsMax = 1000.0;  // 200 A, the largest in a scene, in voxels of 0.05 A
constexpr double kSigmaVoxelsMin = 0.5;     // below this, samples do not represent a Gaussian

struct Tables {
    std::vector<double> smooth, bend;  // halves: [0] is the middle
};

Tables tables(double sigma_voxels) {
    const double s = std::max(sigma_voxels, kSigmaVoxelsMin);
    const auto radius = static_cast<std::size_t>(std::ceil(kCutSigmas * s));
    Tables t;
    double sum = 0.0, bent = 0.0;
    for (std::size_t i = 0; i <= radius; ++i) {
        const double d = static_cast<double>(i) / s, g = std::exp(-0.5 * d * d), twice = i == 0 ? 1.0 : 2.0;
        t.smooth.push_back(g);
        t.bend.push_back((d * d - 1.0) * g);
        sum += twice * g;
        bent += twice * t.bend.back();
    }
    double moment = 0.0;
    for (std::size_t i = 0; i <= radius; ++i) {
        t.bend[i] -= bent / sum * t.smooth[i];
        moment += (i == 0 ? 0.0 : 2.0) * t.bend[i] * static_cast<double>(i) * static_cast<double>(i);
    }
    for (double& v : t.smooth) v /= sum;
    // The factor sigma^2 cancels the Laplacian's unit.
    for (double& v : t.bend) v *= 2.0 * s * s / moment;
    return t;
}

// out[x] (+)= sum_k half[|k|] in[x + k] along one axis; outside the box the input is zero. Processes whole
// rows: the innermost loop always runs along x.
std::vector<float> filtered(const std::vector<float>& in, const std::array<std::uint32_t, 3>& size,
                            std::size_t axis, const std::vector<double>& half) {
    std::vector<float> out(in.size(), 0.0F);
    const std::size_t nx = size[0], rows = std::size_t{size[1]} * size[2];
    const auto n = static_cast<std::ptrdiff_t>(size[axis]);
    const auto radius =
        std::min(static_cast<std::ptrdiff_t>(half.size()), n) - 1;  // larger distances are outside the box
    for (std::size_t row = 0; row < rows; ++row) {
        float* const to = out.data() + row * nx;
        const auto place = static_cast<std::ptrdiff_t>(axis == 1 ? row % size[1] : row / size[1]);
        const auto step = static_cast<std::ptrdiff_t>(axis == 1 ? nx : nx * size[1]);
        for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
            const auto weight = static_cast<float>(half[static_cast<std::size_t>(std::abs(k))]);
            if (axis == 0) {
                const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -k), end = std::min(n, n - k);
                const float* const from = in.data() + row * nx;
                for (std::ptrdiff_t x = begin; x < end; ++x) to[x] += weight * from[x + k];
            } else if (place + k >= 0 && place + k < n) {
                const float* const from = in.data() + static_cast<std::ptrdiff_t>(row * nx) + k * step;
                for (std::size_t x = 0; x < nx; ++x) to[x] += weight * from[x];
            }
        }
    }
    return out;
}

void add(std::vector<float>& to, const std::vector<float>& what) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += what[i];
}

}  // namespace

DensityGrid laplacian_map(const DensityGrid& grid, double background, double resolution_m) {
    if (!(resolution_m > 0.0) || !std::isfinite(resolution_m)) {
        throw StartupError("filtering the map for its contours", "the resolution of the map is unknown",
                           "set it with --resolution-a");
    }
    DensityGrid out = grid;
    for (float& v : out.values) v = static_cast<float>(static_cast<double>(v) - background);
    const double sigma_m = kSigmaPerResolution * resolution_m;
    std::array<Tables, 3> axis;
    for (std::size_t a = 0; a < 3; ++a) {
        const double sigma_voxels = sigma_m / grid.spacing_m[static_cast<Eigen::Index>(a)];
        if (!(sigma_voxels <= kSigmaVoxelsMax)) {
            throw StartupError("filtering the map for its contours",
                               "its voxels are far finer than its resolution",
                               "bin the map and bake it again");
        }
        axis[a] = tables(sigma_voxels);
    }
    std::vector<float> bent = filtered(out.values, grid.size, 0, axis[0].bend);
    std::vector<float> smooth = filtered(out.values, grid.size, 0, axis[0].smooth);
    bent = filtered(bent, grid.size, 1, axis[1].smooth);
    add(bent, filtered(smooth, grid.size, 1, axis[1].bend));
    smooth = filtered(smooth, grid.size, 1, axis[1].smooth);
    out.values = filtered(bent, grid.size, 2, axis[2].smooth);
    add(out.values, filtered(smooth, grid.size, 2, axis[2].bend));
    for (float& v : out.values) v = -v;
    return out;
}

double rms_of(const DensityGrid& grid) {
    double squares = 0.0;
    for (const float v : grid.values) squares += static_cast<double>(v) * static_cast<double>(v);
    return grid.values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(grid.values.size()));
}

}  // namespace tact
