// Density kernel for AVX2 and FMA: prepares eight points at a time as in density_kernel_avx512.cpp, then
// sums them one by one, each 4 x 4 patch in two halves of two rows.
#if defined(__x86_64__)

#include <immintrin.h>

#include "ipc/scene/density/density_kernels.hpp"

#define TACT_AVX2 __attribute__((target("avx2,fma")))

namespace tact {

namespace {

constexpr int kLanes = 8;

struct alignas(32) Block {
    float value_x[4 * kLanes], slope_x[4 * kLanes];  // four per point
    float value_y[4 * kLanes], slope_y[4 * kLanes];
    float value_z[4][kLanes], slope_z[4][kLanes];  // times the point's weight
    float r[3][kLanes];
    std::int32_t offset[kLanes];
    std::int32_t phase[kLanes];  // columns: number of the four x in the second row
};

// By phase: mask of the floats from the second of two rows.
alignas(32) constexpr std::int32_t kSecond[4][kLanes] = {{0, 0, 0, 0, 0, 0, 0, 0},
                                                         {-1, 0, 0, 0, -1, 0, 0, 0},
                                                         {-1, -1, 0, 0, -1, -1, 0, 0},
                                                         {-1, -1, -1, 0, -1, -1, -1, 0}};

struct Weights {
    __m256 value[4], slope[4];
};

TACT_AVX2 inline Weights weights(__m256 f, __m256 per_spacing) {
    const __m256 half = _mm256_set1_ps(0.5F), one = _mm256_set1_ps(1.0F), sixth = _mm256_set1_ps(1.0F / 6.0F);
    const __m256 two_thirds = _mm256_set1_ps(2.0F / 3.0F);
    const __m256 g = _mm256_sub_ps(one, f);
    const __m256 ff = _mm256_mul_ps(f, f), gg = _mm256_mul_ps(g, g);
    Weights w;
    w.value[0] = _mm256_mul_ps(_mm256_mul_ps(gg, g), sixth);
    w.value[1] = _mm256_fmadd_ps(ff, _mm256_fmsub_ps(half, f, one), two_thirds);
    w.value[2] = _mm256_fmadd_ps(gg, _mm256_fmsub_ps(half, g, one), two_thirds);
    w.value[3] = _mm256_mul_ps(_mm256_mul_ps(ff, f), sixth);
    const __m256 two = _mm256_set1_ps(2.0F), three_halves = _mm256_set1_ps(1.5F);
    const __m256 half_s = _mm256_mul_ps(half, per_spacing);
    const __m256 fs = _mm256_mul_ps(f, per_spacing), gs = _mm256_mul_ps(g, per_spacing);
    w.slope[0] = _mm256_sub_ps(_mm256_setzero_ps(), _mm256_mul_ps(gg, half_s));
    w.slope[1] = _mm256_mul_ps(fs, _mm256_fmsub_ps(three_halves, f, two));
    w.slope[2] = _mm256_mul_ps(gs, _mm256_fnmadd_ps(three_halves, g, two));
    w.slope[3] = _mm256_mul_ps(ff, half_s);
    return w;
}

// Transposes four vectors of eight points to four floats per point, points in order.
TACT_AVX2 inline void store_per_point(const __m256* w, float* out) {
    const __m256 a = _mm256_unpacklo_ps(w[0], w[1]), b = _mm256_unpackhi_ps(w[0], w[1]);
    const __m256 c = _mm256_unpacklo_ps(w[2], w[3]), d = _mm256_unpackhi_ps(w[2], w[3]);
    const __m256 p0 = _mm256_shuffle_ps(a, c, 0x44), p1 = _mm256_shuffle_ps(a, c, 0xEE);
    const __m256 p2 = _mm256_shuffle_ps(b, d, 0x44), p3 = _mm256_shuffle_ps(b, d, 0xEE);
    // p_k holds points k, k + 4.
    _mm256_store_ps(out, _mm256_permute2f128_ps(p0, p1, 0x20));
    _mm256_store_ps(out + 8, _mm256_permute2f128_ps(p2, p3, 0x20));
    _mm256_store_ps(out + 16, _mm256_permute2f128_ps(p0, p1, 0x31));
    _mm256_store_ps(out + 24, _mm256_permute2f128_ps(p2, p3, 0x31));
}

// Rotates each weight to the position of its coefficient: w[(e - phase) mod 4] to e.
TACT_AVX2 inline void rotate(__m256i cell, __m256* w) {
    const __m256 by_one = _mm256_castsi256_ps(_mm256_slli_epi32(cell, 31));
    const __m256 by_two = _mm256_castsi256_ps(_mm256_slli_epi32(cell, 30));
    const __m256 a[4] = {_mm256_blendv_ps(w[0], w[3], by_one), _mm256_blendv_ps(w[1], w[0], by_one),
                         _mm256_blendv_ps(w[2], w[1], by_one), _mm256_blendv_ps(w[3], w[2], by_one)};
    for (int e = 0; e < 4; ++e) w[e] = _mm256_blendv_ps(a[e], a[e ^ 2], by_two);
}

template <bool windows>
TACT_AVX2 inline void prepare(const DensityJob& job, std::size_t begin, std::size_t count, Block& block) {
    alignas(32) static constexpr std::int32_t kOn[2 * kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                                 0,  0,  0,  0,  0,  0,  0,  0};
    const __m256i mask = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kOn + (kLanes - count)));
    const __m256 x = _mm256_maskload_ps(job.x + begin, mask), y = _mm256_maskload_ps(job.y + begin, mask);
    const __m256 z = _mm256_maskload_ps(job.z + begin, mask);
    const __m256 weight = _mm256_maskload_ps(job.weight + begin, mask);
    __m256i offset = _mm256_setzero_si256();
    for (int a = 0; a < 3; ++a) {
        const float* row = job.rotation + 3 * a;
        __m256 r = _mm256_mul_ps(_mm256_set1_ps(row[0]), x);
        r = _mm256_fmadd_ps(_mm256_set1_ps(row[1]), y, r);
        r = _mm256_fmadd_ps(_mm256_set1_ps(row[2]), z, r);
        _mm256_store_ps(block.r[a], r);
        const __m256 per_spacing = _mm256_set1_ps(job.per_spacing[a]);
        __m256 t = _mm256_fmadd_ps(r, per_spacing, _mm256_set1_ps(job.fraction[a]));
        t = _mm256_max_ps(t, _mm256_set1_ps(job.low[a]));  // returns the second operand for NaN
        t = _mm256_min_ps(t, _mm256_set1_ps(job.high[a]));
        const __m256 whole = _mm256_floor_ps(t);
        Weights w = weights(_mm256_sub_ps(t, whole), per_spacing);
        __m256i cell = _mm256_add_epi32(_mm256_cvttps_epi32(whole), _mm256_set1_epi32(job.cell[a] - 1));
        if (a == 0 && !windows) {
            rotate(cell, w.value);
            rotate(cell, w.slope);
            _mm256_store_si256(reinterpret_cast<__m256i*>(block.phase),
                               _mm256_and_si256(cell, _mm256_set1_epi32(3)));
            cell = _mm256_srli_epi32(cell, 2);
        }
        const std::int32_t stride = a == 0 ? job.row_stride : a == 1 ? 4 : job.plane_stride;
        offset = _mm256_add_epi32(offset, _mm256_mullo_epi32(cell, _mm256_set1_epi32(stride)));
        if (a == 2) {
            for (int k = 0; k < 4; ++k) {
                _mm256_store_ps(block.value_z[k], _mm256_mul_ps(w.value[k], weight));
                _mm256_store_ps(block.slope_z[k], _mm256_mul_ps(w.slope[k], weight));
            }
        } else {
            store_per_point(w.value, a == 0 ? block.value_x : block.value_y);
            store_per_point(w.slope, a == 0 ? block.slope_x : block.slope_y);
        }
    }
    _mm256_store_si256(reinterpret_cast<__m256i*>(block.offset), offset);
}

// Two rows of four x.
template <bool windows>
TACT_AVX2 inline __m256 load_rows(const float* p, std::ptrdiff_t row_stride, __m256 second) {
    const __m256 rows = _mm256_loadu_ps(p);
    if constexpr (windows) return rows;
    return _mm256_blendv_ps(rows, _mm256_loadu_ps(p + row_stride), second);
}

TACT_AVX2 inline double total(__m256 v) {
    alignas(32) float lane[kLanes];
    _mm256_store_ps(lane, v);
    double sum = 0.0;
    for (const float f : lane) sum += static_cast<double>(f);
    return sum;
}

TACT_AVX2 inline float total_float(__m256 v) {
    __m128 sum = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    sum = _mm_add_ps(sum, _mm_movehl_ps(sum, sum));
    return _mm_cvtss_f32(_mm_add_ss(sum, _mm_shuffle_ps(sum, sum, 1)));
}

// each: writes the gradient of each point too.
template <bool windows, bool each>
TACT_AVX2 void sum_points(const DensityJob& job, DensityJobSums& sums) {
    const std::ptrdiff_t plane_stride = job.plane_stride, row_stride = job.row_stride;
    Block block;
    for (std::size_t first = 0; first < job.count; first += kDensityFlush) {
        const std::size_t end = job.count - first < kDensityFlush ? job.count : first + kDensityFlush;
        __m256 density = _mm256_setzero_ps();
        __m256 gx = density, gy = density, gz = density, mx = density, my = density, mz = density;
        for (std::size_t begin = first; begin < end; begin += kLanes) {
            const std::size_t count = end - begin < kLanes ? end - begin : kLanes;
            prepare<windows>(job, begin, count, block);
            for (std::size_t i = 0; i < count; ++i) {
                const float* const patch = job.coefficients + block.offset[i];
                const __m256 second = windows
                                          ? _mm256_setzero_ps()
                                          : _mm256_castsi256_ps(_mm256_load_si256(
                                                reinterpret_cast<const __m256i*>(kSecond[block.phase[i]])));
                const __m256 x_value =
                    _mm256_broadcast_ps(reinterpret_cast<const __m128*>(block.value_x + 4 * i));
                const __m256 x_slope =
                    _mm256_broadcast_ps(reinterpret_cast<const __m128*>(block.slope_x + 4 * i));
                const __m256 y_values =
                    _mm256_broadcast_ps(reinterpret_cast<const __m128*>(block.value_y + 4 * i));
                const __m256 y_slopes =
                    _mm256_broadcast_ps(reinterpret_cast<const __m128*>(block.slope_y + 4 * i));
                const __m256 rx = _mm256_broadcast_ss(&block.r[0][i]),
                             ry = _mm256_broadcast_ss(&block.r[1][i]);
                const __m256 rz = _mm256_broadcast_ss(&block.r[2][i]);
                __m256 one[3] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
                for (int half = 0; half < 2; ++half) {
                    const float* const p = patch + std::ptrdiff_t{8 * half};
                    __m256 c = load_rows<windows>(p, row_stride, second);
                    __m256 plane = _mm256_mul_ps(c, _mm256_broadcast_ss(&block.value_z[0][i]));
                    __m256 rise = _mm256_mul_ps(c, _mm256_broadcast_ss(&block.slope_z[0][i]));
                    for (int k = 1; k < 4; ++k) {
                        c = load_rows<windows>(p + k * plane_stride, row_stride, second);
                        plane = _mm256_fmadd_ps(c, _mm256_broadcast_ss(&block.value_z[k][i]), plane);
                        rise = _mm256_fmadd_ps(c, _mm256_broadcast_ss(&block.slope_z[k][i]), rise);
                    }
                    const int shift = 2 * half;
                    const __m256i spread = _mm256_set_epi32(shift + 1, shift + 1, shift + 1, shift + 1, shift,
                                                            shift, shift, shift);
                    const __m256 y_value = _mm256_permutevar_ps(y_values, spread);
                    const __m256 y_slope = _mm256_permutevar_ps(y_slopes, spread);
                    const __m256 v = _mm256_mul_ps(plane, x_value);
                    const __m256 px = _mm256_mul_ps(_mm256_mul_ps(plane, x_slope), y_value);
                    const __m256 py = _mm256_mul_ps(v, y_slope);
                    const __m256 pz = _mm256_mul_ps(_mm256_mul_ps(rise, x_value), y_value);
                    density = _mm256_fmadd_ps(v, y_value, density);
                    gx = _mm256_add_ps(gx, px);
                    gy = _mm256_add_ps(gy, py);
                    gz = _mm256_add_ps(gz, pz);
                    if constexpr (each) {
                        one[0] = _mm256_add_ps(one[0], px);
                        one[1] = _mm256_add_ps(one[1], py);
                        one[2] = _mm256_add_ps(one[2], pz);
                    }
                    mx = _mm256_fnmadd_ps(rz, py, _mm256_fmadd_ps(ry, pz, mx));
                    my = _mm256_fnmadd_ps(rx, pz, _mm256_fmadd_ps(rz, px, my));
                    mz = _mm256_fnmadd_ps(ry, px, _mm256_fmadd_ps(rx, py, mz));
                }
                if constexpr (each) {
                    for (int a = 0; a < 3; ++a) job.gradient[a][begin + i] = total_float(one[a]);
                }
            }
        }
        sums.density += total(density);
        sums.gradient[0] += total(gx);
        sums.gradient[1] += total(gy);
        sums.gradient[2] += total(gz);
        sums.moment[0] += total(mx);
        sums.moment[1] += total(my);
        sums.moment[2] += total(mz);
    }
}

}  // namespace

TACT_AVX2 void density_sum_avx2(const DensityJob& job, DensityJobSums& sums) {
    sums = DensityJobSums{};
    const bool each = job.gradient[0] != nullptr;
    if (job.windows) {
        if (each) {
            sum_points<true, true>(job, sums);
        } else {
            sum_points<true, false>(job, sums);
        }
    } else if (each) {
        sum_points<false, true>(job, sums);
    } else {
        sum_points<false, false>(job, sums);
    }
}

}  // namespace tact

#endif
