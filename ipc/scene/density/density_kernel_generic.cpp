// Density kernel for any processor, and the table of all kernels.
#include <cmath>

#include "ipc/scene/density/density_kernels.hpp"

namespace tact {

namespace {

// Weights of the cubic B-spline at the four knots around a point, f in [0, 1) voxels past the second.
void weights(float f, float per_spacing, float* value, float* slope) {
    const float g = 1.0F - f;
    value[0] = g * g * g * (1.0F / 6.0F);
    value[1] = f * f * (0.5F * f - 1.0F) + 2.0F / 3.0F;
    value[2] = g * g * (0.5F * g - 1.0F) + 2.0F / 3.0F;
    value[3] = f * f * f * (1.0F / 6.0F);
    slope[0] = -0.5F * g * g * per_spacing;
    slope[1] = f * (1.5F * f - 2.0F) * per_spacing;
    slope[2] = -g * (1.5F * g - 2.0F) * per_spacing;
    slope[3] = 0.5F * f * f * per_spacing;
}

struct Partial {
    float density = 0.0F, gx = 0.0F, gy = 0.0F, gz = 0.0F, mx = 0.0F, my = 0.0F, mz = 0.0F;
};

template <bool windows>
void add_point(const DensityJob& job, std::size_t i, Partial& out) {
    float r[3], value[3][4], slope[3][4];
    std::ptrdiff_t cell[3];
    for (int a = 0; a < 3; ++a) {
        const float* row = job.rotation + 3 * a;
        r[a] = row[0] * job.x[i] + row[1] * job.y[i] + row[2] * job.z[i];
        float t = r[a] * job.per_spacing[a] + job.fraction[a];
        t = t > job.low[a] ? t : job.low[a];  // also for NaN
        t = t < job.high[a] ? t : job.high[a];
        const float whole = std::floor(t);
        weights(t - whole, job.per_spacing[a], value[a], slope[a]);
        cell[a] = static_cast<std::int32_t>(whole) + job.cell[a] - 1;
    }
    const float* const patch = job.coefficients + cell[2] * job.plane_stride + 4 * cell[1];
    std::ptrdiff_t place[4];  // offsets of the four x
    for (int x = 0; x < 4; ++x) {
        const std::ptrdiff_t at = cell[0] + x;
        place[x] = at / 4 * job.row_stride + at % 4;
    }
    const std::ptrdiff_t first = windows ? cell[0] * job.row_stride : 0;
    float density = 0.0F, gx = 0.0F, gy = 0.0F, gz = 0.0F;
    for (int y = 0; y < 4; ++y) {
        float plane[4] = {0.0F, 0.0F, 0.0F, 0.0F}, rise[4] = {0.0F, 0.0F, 0.0F, 0.0F};
        for (int z = 0; z < 4; ++z) {
            const float* const row =
                patch + first + std::ptrdiff_t{z} * job.plane_stride + std::ptrdiff_t{4 * y};
            for (int x = 0; x < 4; ++x) {
                const float c = row[windows ? x : place[x]];
                plane[x] += value[2][z] * c;
                rise[x] += slope[2][z] * c;
            }
        }
        float v = 0.0F, vx = 0.0F, vz = 0.0F;
        for (int x = 0; x < 4; ++x) {
            v += plane[x] * value[0][x];
            vx += plane[x] * slope[0][x];
            vz += rise[x] * value[0][x];
        }
        density += v * value[1][y];
        gx += vx * value[1][y];
        gy += v * slope[1][y];
        gz += vz * value[1][y];
    }
    const float w = job.weight[i];
    gx *= w, gy *= w, gz *= w;
    if (job.gradient[0] != nullptr) {
        job.gradient[0][i] = gx;
        job.gradient[1][i] = gy;
        job.gradient[2][i] = gz;
    }
    out.density += w * density;
    out.gx += gx, out.gy += gy, out.gz += gz;
    out.mx += r[1] * gz - r[2] * gy;
    out.my += r[2] * gx - r[0] * gz;
    out.mz += r[0] * gy - r[1] * gx;
}

template <bool windows>
void sum_points(const DensityJob& job, DensityJobSums& sums) {
    for (std::size_t begin = 0; begin < job.count; begin += kDensityFlush) {
        const std::size_t end = job.count - begin < kDensityFlush ? job.count : begin + kDensityFlush;
        Partial part;
        for (std::size_t i = begin; i < end; ++i) add_point<windows>(job, i, part);
        sums.density += static_cast<double>(part.density);
        sums.gradient[0] += static_cast<double>(part.gx);
        sums.gradient[1] += static_cast<double>(part.gy);
        sums.gradient[2] += static_cast<double>(part.gz);
        sums.moment[0] += static_cast<double>(part.mx);
        sums.moment[1] += static_cast<double>(part.my);
        sums.moment[2] += static_cast<double>(part.mz);
    }
}

bool always() { return true; }
#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
bool has_avx512() { return has_avx2() && __builtin_cpu_supports("avx512f"); }
#endif

}  // namespace

void density_sum_generic(const DensityJob& job, DensityJobSums& sums) {
    sums = DensityJobSums{};
    if (job.windows) {
        sum_points<true>(job, sums);
    } else {
        sum_points<false>(job, sums);
    }
}

const DensityKernel kDensityKernels[] = {
#if defined(__x86_64__)
    {"avx512", &has_avx512, &density_sum_avx512},
    {"avx2", &has_avx2, &density_sum_avx2},
#endif
    {"generic", &always, &density_sum_generic},
};
const std::size_t kDensityKernelCount = sizeof(kDensityKernels) / sizeof(kDensityKernels[0]);

}  // namespace tact
