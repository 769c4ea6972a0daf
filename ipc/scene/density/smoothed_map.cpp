// The discrete Gaussian of variance t (in voxels squared) has the values exp(-t) I_n(t), with the modified Bessel functions
// I_n, and multiplies a wave cos(w x) by exp(-t (1 - cos w)). A sampled Gaussian narrower than two thirds of a voxel has
// another variance than the continuous one; wide ones are equal, and are used where exp(t) overflows.
#include "ipc/scene/density/smoothed_map.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

namespace {

constexpr double kBorderSigmas = 3.0;
constexpr double kTailLeast = 1e-6;   // of the kernel's sum
constexpr double kBesselMax = 100.0;  // variance

// Halves: [0] is the middle.
std::vector<float> discrete_gaussian(double t) {
    std::vector<double> half;
    double sum = 0.0;
    while (1.0 - sum > kTailLeast && half.size() < 4096) {
        const auto n = static_cast<double>(half.size());
        const double v = t < kBesselMax ? std::exp(-t) * std::cyl_bessel_i(n, t)
                                        : std::exp(-0.5 * n * n / t) / std::sqrt(2.0 * M_PI * t);
        half.push_back(v);
        sum += half.size() == 1 ? v : 2.0 * v;
    }
    std::vector<float> out;
    for (const double v : half) out.push_back(static_cast<float>(v / sum));
    return out;
}

struct Line {
    std::size_t before, after;  // voxels along the axis
    std::ptrdiff_t border;      // in voxels of the input
    std::ptrdiff_t every;
    [[nodiscard]] std::ptrdiff_t middle(std::size_t i) const {
        return static_cast<std::ptrdiff_t>(i) * every - border;
    }
};

// to += weight * from, over whole rows along x; the innermost loop of the axes y and z.
void add_row(float* to, const float* from, float weight, std::size_t count) {
    for (std::size_t x = 0; x < count; ++x) to[x] += weight * from[x];
}

// Filters along one axis; slow is the number of lines' blocks outside it, fast the number of values inside it.
std::vector<float> filtered_along(const std::vector<float>& in, std::size_t slow, std::size_t fast,
                                  const Line& line, const std::vector<float>& half) {
    std::vector<float> out(slow * line.after * fast, 0.0F);
    const auto radius = static_cast<std::ptrdiff_t>(half.size()) - 1,
               n = static_cast<std::ptrdiff_t>(line.before);
    for (std::size_t s = 0; s < slow; ++s) {
        const float* const from = in.data() + s * line.before * fast;
        float* const to = out.data() + s * line.after * fast;
        for (std::size_t i = 0; i < line.after; ++i) {
            const std::ptrdiff_t middle = line.middle(i);
            const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, middle - radius);
            const std::ptrdiff_t end = std::min(n, middle + radius + 1);
            for (std::ptrdiff_t k = begin; k < end; ++k)
                add_row(to + i * fast, from + static_cast<std::size_t>(k) * fast,
                        half[static_cast<std::size_t>(std::abs(k - middle))], fast);
        }
    }
    return out;
}

}  // namespace

DensityGrid smoothed_map(const DensityGrid& grid, double background, double sigma_m, std::uint32_t every) {
    DensityGrid out = grid;
    std::vector<float> values(grid.values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double v = static_cast<double>(grid.values[i]) - background;
        values[i] = std::isfinite(v) ? static_cast<float>(v) : 0.0F;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        const double sigma = sigma_m / grid.spacing_m[axis];
        Line line{};
        line.before = grid.size[a];
        line.every = every;
        line.border = static_cast<std::ptrdiff_t>(std::ceil(kBorderSigmas * sigma));
        line.after = (line.before + static_cast<std::size_t>(2 * line.border) + every - 2) / every + 1;
        out.size[a] = static_cast<std::uint32_t>(line.after);
        out.origin_m[axis] -= static_cast<double>(line.border) * grid.spacing_m[axis];
        out.spacing_m[axis] *= every;
        const std::size_t fast = a == 0 ? 1 : a == 1 ? out.size[0] : std::size_t{out.size[0]} * out.size[1];
        const std::size_t slow = a == 0   ? std::size_t{grid.size[1]} * grid.size[2]
                                 : a == 1 ? grid.size[2]
                                          : 1;
        values = filtered_along(values, slow, fast, line, discrete_gaussian(sigma * sigma));
    }
    for (float& v : values) v += static_cast<float>(background);
    out.values = std::move(values);
    return out;
}

}  // namespace tact
