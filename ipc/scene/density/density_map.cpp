// Spline coefficients and their evaluation.
//
// Interpolation: coefficients c with sum_k c[k] B(i - k) = s[i] for all integers i, with s the normalized
// map inside its box and zero outside (Unser, Aldroubi, Eden 1993). Per axis a causal and an anticausal
// recursion with the pole z = sqrt(3) - 2 and gain 6; with zeros outside, both have exact initial values.
// The coefficients continue beyond the box and fall by 0.268 per voxel; kDensityReach of them are kept (0.268^8 =
// 3e-5 of the value at the border, half of which is the interpolation error there), then kDensityZero layers of
// zeros, to which far points are clamped: no branch, no access out of bounds, and the spline stays C2 for
// any coefficients.
//
// scipy.ndimage.spline_filter(order=3) gives the same numbers on the map padded with 12 or more zeros.
//
// Slope: an interpolating spline passes through the values and is too flat between them. Averaged over all positions of a
// wave cos(w x) on the voxels, its slope is B(w) / sum_k B(w + 2 pi k) of the true one, with B(w) = (sin(w/2) / (w/2))^4:
// 0.986 for four voxels per wave, 0.938 for three. A body has atoms at all positions, so this is what its force loses. So
// the values are sharpened by 1 + (1 - cos w)^3 / 54 beforehand, seven values per axis, which makes it 1.004 and 0.997. At
// two voxels per wave the sharpening is 1.15; the exact inverse, 2.03, would amplify the noise of measured maps. What
// remains in a single place is the image of the wave at w - 2 pi, 4 % of the slope at four voxels per wave: no filter of the
// values removes it, and it averages out over atoms. Force on all atoms against the analytic force of the Gaussians from
// which the map was simulated, RMS over poses around the answer, for 3, 3.5 and 4 voxels per resolution, interpolating and
// sharpened: 1AKE at 10 A 2.8, 1.8, 1.1 % and 2.2, 1.5, 0.8 %; at 20 A 4.2, 2.4, 1.3 % and 2.5, 1.3, 0.5 %; a chain of 1OEL at
// 7 A 5.2, 2.3, 1.2 % and 4.0, 1.5, 1.0 %. The rest is in the samples: waves shorter than two voxels, which alias. A windowed
// sinc of 24 voxels, the limit of the band, has 2.8 % and 0.5 % (1AKE, 10 A, 3 and 4 voxels).
#include "ipc/scene/density/density_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/density_kernels.hpp"
#include "ipc/scene/density/density_layout.hpp"

namespace tact {

namespace {

constexpr double kCellMax = 1e6;  // farther from the box than any practical pose; keeps the integers small
// From this number of points on, columns are faster than windows: adjacent points share cache lines, and
// the part of the map that a body covers stays in a cache of one or two megabytes. Fewer points, far apart,
// share none, and windows need half as many lines. 225 000 voxels, 100 000 points: 0.9 ms, with windows 2.9
// ms; 200 points: 2.9 us, with windows 2.1 us (fastest of many, 2026-11-21, Sapphire Rapids).
constexpr std::size_t kMany = 1024;

// Sharpening 1 + (1 - cos w)^3 / 54: factors of a value and of its neighbours at one, two and three voxels.
constexpr std::size_t kSharpReach = 3;
constexpr std::array<double, kSharpReach + 1> kSharp{1.0 + 2.5 / 54.0, -1.875 / 54.0, 0.75 / 54.0,
                                                     -0.125 / 54.0};
constexpr std::array<double, kSharpReach + 1> kPlain{1.0, 0.0, 0.0, 0.0};
static_assert(kDensityReach > static_cast<std::int32_t>(kSharpReach));

// Filters `lines` interleaved lines of `count` samples (sample i of line j at i * stride + j), in place. On
// entry the first and last kDensityPad samples are zero; on return they hold the filter's tails, cut after kDensityReach.
void prefilter_lines(float* data, std::int32_t count, std::size_t stride, std::size_t lines,
                     const std::array<double, kSharpReach + 1>& sharp, std::vector<double>& work) {
    const double z = std::sqrt(3.0) - 2.0;
    const auto first = static_cast<std::size_t>(kDensityPad) - kSharpReach;
    const auto last = static_cast<std::size_t>(count - kDensityPad - 1) + kSharpReach;
    const auto begin = static_cast<std::size_t>(kDensityZero),
               end = static_cast<std::size_t>(count - kDensityZero);
    work.assign(static_cast<std::size_t>(count) * lines, 0.0);
    for (std::size_t i = first; i < end; ++i) {
        const float* const here = data + i * stride;
        for (std::size_t j = 0; j < lines; ++j) {
            double sample = 0.0;
            if (i <= last) {
                sample = sharp[0] * static_cast<double>(here[j]);
                for (std::size_t k = 1; k <= kSharpReach; ++k)
                    sample += sharp[k] * (static_cast<double>(here[j + k * stride]) +
                                          static_cast<double>(*(here + j - k * stride)));
            }
            work[i * lines + j] = 6.0 * sample + z * work[(i - 1) * lines + j];
        }
    }
    for (std::size_t j = 0; j < lines; ++j) work[(end - 1) * lines + j] *= -z / (1.0 - z * z);
    for (std::size_t i = end - 1; i-- > begin;) {
        for (std::size_t j = 0; j < lines; ++j) {
            work[i * lines + j] = z * (work[(i + 1) * lines + j] - work[i * lines + j]);
        }
    }
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t j = 0; j < lines; ++j)
            data[i * stride + j] = static_cast<float>(work[i * lines + j]);
    }
}

void prefilter(HugeBuffer& c, const std::array<std::int32_t, 3>& n,
               const std::array<double, kSharpReach + 1>& sharp) {
    const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
    const auto nz = static_cast<std::size_t>(n[2]);
    constexpr std::size_t kGroup =
        32;  // lines filtered together along y and z: whole cache lines, in vectors
    std::vector<double> work;
    for (std::size_t z = 0; z < nz; ++z) {
        for (std::size_t y = 0; y < ny; ++y) prefilter_lines(&c[(z * ny + y) * nx], n[0], 1, 1, sharp, work);
        for (std::size_t x = 0; x < nx; x += kGroup) {
            prefilter_lines(&c[z * ny * nx + x], n[1], nx, std::min(kGroup, nx - x), sharp, work);
        }
    }
    for (std::size_t y = 0; y < ny; ++y) {
        for (std::size_t x = 0; x < nx; x += kGroup) {
            prefilter_lines(&c[y * nx + x], n[2], nx * ny, std::min(kGroup, nx - x), sharp, work);
        }
    }
}

// Coefficients in rows of four x, see density_kernels.hpp.
HugeBuffer in_rows(const HugeBuffer& c, const std::array<std::int32_t, 3>& n, bool windows) {
    const DensityLayout layout = density_layout(n, windows);
    const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
    const auto nz = static_cast<std::size_t>(n[2]), step = static_cast<std::size_t>(layout.step);
    HugeBuffer out(nz * static_cast<std::size_t>(layout.plane_stride) + 4 * ny);
    float* row = out.data();
    for (std::size_t z = 0; z < nz; ++z) {
        for (std::size_t x = 0; x < nx; x += step) {
            for (std::size_t y = 0; y < ny; ++y, row += 4) {
                const float* const from = c.data() + (z * ny + y) * nx + x;
                std::copy(from, from + std::min<std::size_t>(4, nx - x), row);
            }
        }
    }
    return out;
}

void check(const DensityGrid& grid, double background, double sigma) {
    const std::string attempt = "building the density map";
    for (const std::uint32_t n : grid.size) {
        if (n < 1 || n > 16384)
            throw StartupError(attempt, "its size is out of range",
                               "use a map of 1 to 16384 voxels per side");
    }
    if (grid.values.size() != grid.count()) {
        throw StartupError(attempt, "its number of values differs from its number of voxels",
                           "bake the scene again");
    }
    if (!grid.origin_m.allFinite() || !grid.spacing_m.allFinite() || grid.spacing_m.minCoeff() <= 0.0) {
        throw StartupError(attempt, "its origin or voxel size is not finite or not positive",
                           "bake the scene again");
    }
    if (!(sigma > 0.0) || !std::isfinite(sigma) || !std::isfinite(background)) {
        throw StartupError(attempt, "its standard deviation is not positive",
                           "use a map that is not constant");
    }
}

const DensityKernel* best_kernel() {
    const DensityKernel* kernel = kDensityKernels;
    while (!kernel->runs_here()) ++kernel;  // the last one runs everywhere
    return kernel;
}

void spline_weights(double f, double per_spacing, double* value, double* slope) {
    const double g = 1.0 - f;
    value[0] = g * g * g / 6.0;
    value[1] = f * f * (0.5 * f - 1.0) + 2.0 / 3.0;
    value[2] = g * g * (0.5 * g - 1.0) + 2.0 / 3.0;
    value[3] = f * f * f / 6.0;
    slope[0] = -0.5 * g * g * per_spacing;
    slope[1] = f * (1.5 * f - 2.0) * per_spacing;
    slope[2] = -g * (1.5 * g - 2.0) * per_spacing;
    slope[3] = 0.5 * f * f * per_spacing;
}

}  // namespace

DensityMap::DensityMap(const DensityGrid& grid, double background, double sigma, const Options& options)
    : origin_m_(grid.origin_m),
      spacing_m_(grid.spacing_m),
      size_(grid.size),
      kernel_(options.kernel != nullptr ? options.kernel : best_kernel()) {
    check(grid, background, sigma);
    std::size_t count = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        padded_[a] = static_cast<std::int32_t>(size_[a]) + 2 * kDensityPad;
        count *= static_cast<std::size_t>(padded_[a]);
    }
    if (count + 4 * count / static_cast<std::size_t>(padded_[0]) >
        static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
        throw StartupError("building the density map", "it has more than 2^31 voxels", "cut or bin the map");
    }
    HugeBuffer c(count);
    const auto nx = static_cast<std::size_t>(padded_[0]), ny = static_cast<std::size_t>(padded_[1]);
    for (std::uint32_t z = 0; z < size_[2]; ++z) {
        for (std::uint32_t y = 0; y < size_[1]; ++y) {
            float* const row = &c[((z + kDensityPad) * ny + y + kDensityPad) * nx + kDensityPad];
            for (std::uint32_t x = 0; x < size_[0]; ++x) {
                const double v = (static_cast<double>(grid.at(x, y, z)) - background) / sigma;
                row[x] = std::isfinite(v) ? static_cast<float>(std::clamp(v, -1e6, 1e6)) : 0.0F;
            }
        }
    }
    prefilter(c, padded_, options.interpolating ? kPlain : kSharp);
    columns_ = in_rows(c, padded_, false);
    if (4 * count * sizeof(float) <= options.windows_bytes_max) windows_ = in_rows(c, padded_, true);
}

const char* DensityMap::kernel_name() const noexcept { return kernel_->name; }

double DensityMap::sample(const Vec3& point_model_m, Vec3& gradient) const noexcept {
    double value[3][4], slope[3][4];
    std::ptrdiff_t cell[3];
    for (int a = 0; a < 3; ++a) {
        double t = (point_model_m[a] - origin_m_[a]) / spacing_m_[a] + kDensityPad;
        const double low = 1.0, high = padded_[static_cast<std::size_t>(a)] - 3;
        t = t > low ? t : low;  // also for NaN
        t = t < high ? t : high;
        const double whole = std::floor(t);
        spline_weights(t - whole, 1.0 / spacing_m_[a], value[a], slope[a]);
        cell[a] = static_cast<std::ptrdiff_t>(whole) - 1;
    }
    const DensityLayout layout = density_layout(padded_, false);
    double density = 0.0;
    gradient.setZero();
    for (int z = 0; z < 4; ++z) {
        for (int y = 0; y < 4; ++y) {
            const float* const row =
                columns_.data() + (cell[2] + z) * layout.plane_stride + 4 * (cell[1] + y);
            double v = 0.0, vx = 0.0;
            for (int x = 0; x < 4; ++x) {
                const std::ptrdiff_t at = cell[0] + x;
                const double c = static_cast<double>(row[at / 4 * layout.row_stride + at % 4]);
                v += value[0][x] * c;
                vx += slope[0][x] * c;
            }
            density += v * value[1][y] * value[2][z];
            gradient += Vec3(vx * value[1][y] * value[2][z], v * slope[1][y] * value[2][z],
                             v * value[1][y] * slope[2][z]);
        }
    }
    return density;
}

DensitySums DensityMap::sum(const PointsView& points, const Pose& T_model_body,
                            const PointGradients* each) const noexcept {
    DensitySums sums;
    const double norm = T_model_body.q.norm();
    if (!T_model_body.finite() || !(norm > 1e-6 && norm < 1e6)) return sums;
    const Eigen::Matrix3d rotation = Quat(T_model_body.q.coeffs() / norm).toRotationMatrix();
    DensityJob job{};
    job.x = points.x.data(), job.y = points.y.data(), job.z = points.z.data();
    job.weight = points.weight.data();
    job.count = std::min({points.x.size(), points.y.size(), points.z.size(), points.weight.size()});
    if (each != nullptr) {
        job.count = std::min({job.count, each->x.size(), each->y.size(), each->z.size()});
        job.gradient[0] = each->x.data(), job.gradient[1] = each->y.data(), job.gradient[2] = each->z.data();
    }
    job.windows = job.count < kMany && windows_.size() > 0;
    const DensityLayout layout = density_layout(padded_, job.windows);
    job.coefficients = job.windows ? windows_.data() : columns_.data();
    job.row_stride = layout.row_stride;
    job.plane_stride = layout.plane_stride;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        for (int b = 0; b < 3; ++b) job.rotation[3 * a + b] = static_cast<float>(rotation(a, b));
        job.per_spacing[a] = static_cast<float>(1.0 / spacing_m_[a]);
        const double place = (T_model_body.p_m[a] - origin_m_[a]) / spacing_m_[a] + kDensityPad;
        const double cell = std::clamp(std::floor(place), -kCellMax, kCellMax);
        job.cell[a] = static_cast<std::int32_t>(cell);
        job.fraction[a] = static_cast<float>(std::clamp(place - cell, -kCellMax, kCellMax));
        job.low[a] = static_cast<float>(1.0 - cell);
        job.high[a] = static_cast<float>(padded_[axis] - 3.0 - cell);
    }
    DensityJobSums raw;
    kernel_->sum(job, raw);
    const Vec3 gradient(raw.gradient[0], raw.gradient[1], raw.gradient[2]);
    const Vec3 moment(raw.moment[0], raw.moment[1], raw.moment[2]);
    // Non-finite or extremely distant points can give a non-finite moment.
    if (!std::isfinite(raw.density) || !gradient.allFinite() || !moment.allFinite()) return sums;
    sums.density_sigma = raw.density;
    sums.gradient = gradient;
    sums.moment = moment;
    return sums;
}

}  // namespace tact
