// Density kernel for AVX-512 (F only).
//
// Sixteen points at a time: their places and spline weights are computed in structure-of-arrays form. Then,
// for four points at a time, each point's 64 coefficients are four loads that are summed along z. The four
// results of 4 y x 4 x are transposed into four vectors of 4 points x 4 x, one for each y, and summed along
// y. Since force and torque are sums, such a vector is all that the cross product needs, and one horizontal
// sum per kDensityFlush points remains. The point's weight rides on those along z.
//
// The four points of a vector are k, k + 4, k + 8, k + 12, so that their weights along y are one permutation
// within lanes of what was computed for all sixteen. Weighting along y before the transposition, and folding
// lanes after it, took a quarter more shuffles: 1.01 ms for 100 000 atoms where this takes 0.98 (medians of
// runs in alternation, 2026-11-20).
#if defined(__x86_64__)

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of its own header's deliberately undefined registers (bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>

#include "ipc/assets/density_kernels.hpp"

#define TACT_AVX512 __attribute__((target("avx512f,avx2,fma")))

namespace tact {

namespace {

constexpr int kLanes = 16;
// Sums of fewer points find their coefficients in the caches, and would only pay for asking: 200 points 2.2
// us, asking 2.6; 100 000 points 1.06 ms, asking 0.99 (fastest of many, 2026-11-20).
constexpr std::size_t kFetchFrom = 1024;

// Point k + 4 l of the sixteen has its four weights along x in lane l of value_x[k]; value_y[j] has the
// weight of row j of all sixteen.
struct alignas(64) Block {
    __m512 value_x[4], slope_x[4], value_y[4], slope_y[4];
    float value_z[4][kLanes], slope_z[4][kLanes];  // times the point's weight
    __m512 r[3];
    std::int32_t offset[kLanes];
};

struct Weights {
    __m512 value[4], slope[4];
};

TACT_AVX512 inline Weights weights(__m512 f, __m512 per_spacing) {
    const __m512 half = _mm512_set1_ps(0.5F), one = _mm512_set1_ps(1.0F), sixth = _mm512_set1_ps(1.0F / 6.0F);
    const __m512 two_thirds = _mm512_set1_ps(2.0F / 3.0F);
    const __m512 g = _mm512_sub_ps(one, f);
    const __m512 ff = _mm512_mul_ps(f, f), gg = _mm512_mul_ps(g, g);
    Weights w;
    w.value[0] = _mm512_mul_ps(_mm512_mul_ps(gg, g), sixth);
    w.value[1] = _mm512_fmadd_ps(ff, _mm512_fmsub_ps(half, f, one), two_thirds);
    w.value[2] = _mm512_fmadd_ps(gg, _mm512_fmsub_ps(half, g, one), two_thirds);
    w.value[3] = _mm512_mul_ps(_mm512_mul_ps(ff, f), sixth);
    const __m512 two = _mm512_set1_ps(2.0F), three_halves = _mm512_set1_ps(1.5F);
    const __m512 half_s = _mm512_mul_ps(half, per_spacing);
    const __m512 fs = _mm512_mul_ps(f, per_spacing), gs = _mm512_mul_ps(g, per_spacing);
    w.slope[0] = _mm512_sub_ps(_mm512_setzero_ps(), _mm512_mul_ps(gg, half_s));
    w.slope[1] = _mm512_mul_ps(fs, _mm512_fmsub_ps(three_halves, f, two));
    w.slope[2] = _mm512_mul_ps(gs, _mm512_fnmadd_ps(three_halves, g, two));
    w.slope[3] = _mm512_mul_ps(ff, half_s);
    return w;
}

TACT_AVX512 inline void by_point(const __m512* w, __m512* out) {
    const __m512 a = _mm512_unpacklo_ps(w[0], w[1]), b = _mm512_unpackhi_ps(w[0], w[1]);
    const __m512 c = _mm512_unpacklo_ps(w[2], w[3]), d = _mm512_unpackhi_ps(w[2], w[3]);
    out[0] = _mm512_shuffle_ps(a, c, 0x44);
    out[1] = _mm512_shuffle_ps(a, c, 0xEE);
    out[2] = _mm512_shuffle_ps(b, d, 0x44);
    out[3] = _mm512_shuffle_ps(b, d, 0xEE);
}

TACT_AVX512 inline void prepare(const DensityJob& job, std::size_t begin, std::size_t count, bool fetch,
                                Block& block) {
    // Points beyond the last get no weight and lie at the body's origin.
    const __mmask16 mask = count >= kLanes ? __mmask16{0xFFFF} : static_cast<__mmask16>((1U << count) - 1U);
    const __m512 x = _mm512_maskz_loadu_ps(mask, job.x + begin);
    const __m512 y = _mm512_maskz_loadu_ps(mask, job.y + begin);
    const __m512 z = _mm512_maskz_loadu_ps(mask, job.z + begin);
    const __m512 weight = _mm512_maskz_loadu_ps(mask, job.weight + begin);
    __m512i offset = _mm512_setzero_si512();
    for (int a = 0; a < 3; ++a) {
        const float* row = job.rotation + 3 * a;
        __m512 r = _mm512_mul_ps(_mm512_set1_ps(row[0]), x);
        r = _mm512_fmadd_ps(_mm512_set1_ps(row[1]), y, r);
        r = _mm512_fmadd_ps(_mm512_set1_ps(row[2]), z, r);
        block.r[a] = r;
        const __m512 per_spacing = _mm512_set1_ps(job.per_spacing[a]);
        __m512 t = _mm512_fmadd_ps(r, per_spacing, _mm512_set1_ps(job.fraction[a]));
        t = _mm512_max_ps(t, _mm512_set1_ps(job.low[a]));  // the second operand where t is not a number
        t = _mm512_min_ps(t, _mm512_set1_ps(job.high[a]));
        const __m512 whole = _mm512_roundscale_ps(t, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
        const Weights w = weights(_mm512_sub_ps(t, whole), per_spacing);
        const __m512i cell = _mm512_add_epi32(_mm512_cvttps_epi32(whole), _mm512_set1_epi32(job.cell[a] - 1));
        offset = _mm512_add_epi32(offset, _mm512_mullo_epi32(cell, _mm512_set1_epi32(job.stride[a])));
        if (a == 2) {
            for (int k = 0; k < 4; ++k) {
                _mm512_store_ps(block.value_z[k], _mm512_mul_ps(w.value[k], weight));
                _mm512_store_ps(block.slope_z[k], _mm512_mul_ps(w.slope[k], weight));
            }
        } else if (a == 1) {
            for (int j = 0; j < 4; ++j) {
                block.value_y[j] = w.value[j];
                block.slope_y[j] = w.slope[j];
            }
        } else {
            by_point(w.value, block.value_x);
            by_point(w.slope, block.slope_x);
        }
    }
    _mm512_store_si512(block.offset, offset);
    if (!fetch) return;
    for (int i = 0; i < kLanes; ++i) {
        const float* const patch = job.coefficients + block.offset[i];
        for (int plane = 0; plane < 4; ++plane) {
            _mm_prefetch(reinterpret_cast<const char*>(patch + plane * std::ptrdiff_t{job.stride[2]}),
                         _MM_HINT_T0);
        }
    }
}

// Four rows of four x at z plane k.
template <bool interleaved>
TACT_AVX512 inline __m512 load_patch(const float* p, std::ptrdiff_t row_stride) {
    if constexpr (interleaved) return _mm512_loadu_ps(p);
    const __m512 a = _mm512_castps128_ps512(_mm_loadu_ps(p));
    const __m512 ab = _mm512_insertf32x4(a, _mm_loadu_ps(p + row_stride), 1);
    const __m512 abc = _mm512_insertf32x4(ab, _mm_loadu_ps(p + 2 * row_stride), 2);
    return _mm512_insertf32x4(abc, _mm_loadu_ps(p + 3 * row_stride), 3);
}

// Lane l of out[j] is lane j of v[l].
TACT_AVX512 inline void transpose_lanes(const __m512* v, __m512* out) {
    const __m512 low01 = _mm512_shuffle_f32x4(v[0], v[1], 0x44),
                 high01 = _mm512_shuffle_f32x4(v[0], v[1], 0xEE);
    const __m512 low23 = _mm512_shuffle_f32x4(v[2], v[3], 0x44),
                 high23 = _mm512_shuffle_f32x4(v[2], v[3], 0xEE);
    out[0] = _mm512_shuffle_f32x4(low01, low23, 0x88);
    out[1] = _mm512_shuffle_f32x4(low01, low23, 0xDD);
    out[2] = _mm512_shuffle_f32x4(high01, high23, 0x88);
    out[3] = _mm512_shuffle_f32x4(high01, high23, 0xDD);
}

struct Accumulators {
    __m512 density, gx, gy, gz, mx, my, mz;
};

// Points k, k + 4, k + 8, k + 12 of the block.
template <bool interleaved, int k>
TACT_AVX512 inline void add_four(const DensityJob& job, const Block& block, Accumulators& sum) {
    const std::ptrdiff_t z_stride = job.stride[2], row_stride = job.row_stride;
    __m512 planes[4], rises[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; ++l) {
        const int i = k + 4 * l;
        const float* const p = job.coefficients + block.offset[i];
        __m512 c = load_patch<interleaved>(p, row_stride);
        __m512 plane = _mm512_mul_ps(c, _mm512_set1_ps(block.value_z[0][i]));
        __m512 rise = _mm512_mul_ps(c, _mm512_set1_ps(block.slope_z[0][i]));
#pragma GCC unroll 3
        for (int z = 1; z < 4; ++z) {
            c = load_patch<interleaved>(p + z * z_stride, row_stride);
            plane = _mm512_fmadd_ps(c, _mm512_set1_ps(block.value_z[z][i]), plane);
            rise = _mm512_fmadd_ps(c, _mm512_set1_ps(block.slope_z[z][i]), rise);
        }
        planes[l] = plane;
        rises[l] = rise;
    }
    __m512 plane_y[4], rise_y[4];
    transpose_lanes(planes, plane_y);
    transpose_lanes(rises, rise_y);
    __m512 value = _mm512_permute_ps(block.value_y[0], k * 0x55);
    __m512 row = _mm512_mul_ps(plane_y[0], value);
    __m512 row_z = _mm512_mul_ps(rise_y[0], value);
    __m512 row_y = _mm512_mul_ps(plane_y[0], _mm512_permute_ps(block.slope_y[0], k * 0x55));
#pragma GCC unroll 3
    for (int j = 1; j < 4; ++j) {
        value = _mm512_permute_ps(block.value_y[j], k * 0x55);
        row = _mm512_fmadd_ps(plane_y[j], value, row);
        row_z = _mm512_fmadd_ps(rise_y[j], value, row_z);
        row_y = _mm512_fmadd_ps(plane_y[j], _mm512_permute_ps(block.slope_y[j], k * 0x55), row_y);
    }
    const __m512 px = _mm512_mul_ps(row, block.slope_x[k]);
    const __m512 py = _mm512_mul_ps(row_y, block.value_x[k]);
    const __m512 pz = _mm512_mul_ps(row_z, block.value_x[k]);
    sum.density = _mm512_fmadd_ps(row, block.value_x[k], sum.density);
    sum.gx = _mm512_add_ps(sum.gx, px);
    sum.gy = _mm512_add_ps(sum.gy, py);
    sum.gz = _mm512_add_ps(sum.gz, pz);
    const __m512 rx = _mm512_permute_ps(block.r[0], k * 0x55), ry = _mm512_permute_ps(block.r[1], k * 0x55);
    const __m512 rz = _mm512_permute_ps(block.r[2], k * 0x55);
    sum.mx = _mm512_fnmadd_ps(rz, py, _mm512_fmadd_ps(ry, pz, sum.mx));
    sum.my = _mm512_fnmadd_ps(rx, pz, _mm512_fmadd_ps(rz, px, sum.my));
    sum.mz = _mm512_fnmadd_ps(ry, px, _mm512_fmadd_ps(rx, py, sum.mz));
}

TACT_AVX512 inline double total(__m512 v) {
    alignas(64) float lane[kLanes];
    _mm512_store_ps(lane, v);
    double sum = 0.0;
    for (const float f : lane) sum += static_cast<double>(f);
    return sum;
}

template <bool interleaved>
TACT_AVX512 void sum_points(const DensityJob& job, DensityJobSums& sums) {
    const bool fetch = job.count >= kFetchFrom;
    Block blocks[2];  // one is prepared, and its coefficients asked for, while the other is summed
    for (std::size_t first = 0; first < job.count; first += kDensityFlush) {
        const std::size_t end = job.count - first < kDensityFlush ? job.count : first + kDensityFlush;
        const __m512 zero = _mm512_setzero_ps();
        Accumulators sum{zero, zero, zero, zero, zero, zero, zero};
        prepare(job, first, end - first, fetch, blocks[0]);
        int turn = 0;
        for (std::size_t begin = first; begin < end; begin += kLanes, turn ^= 1) {
            if (begin + kLanes < end)
                prepare(job, begin + kLanes, end - begin - kLanes, fetch, blocks[turn ^ 1]);
            const Block& block = blocks[turn];
            add_four<interleaved, 0>(job, block, sum);
            add_four<interleaved, 1>(job, block, sum);
            add_four<interleaved, 2>(job, block, sum);
            add_four<interleaved, 3>(job, block, sum);
        }
        sums.density += total(sum.density);
        sums.gradient[0] += total(sum.gx);
        sums.gradient[1] += total(sum.gy);
        sums.gradient[2] += total(sum.gz);
        sums.moment[0] += total(sum.mx);
        sums.moment[1] += total(sum.my);
        sums.moment[2] += total(sum.mz);
    }
}

}  // namespace

TACT_AVX512 void density_sum_avx512(const DensityJob& job, DensityJobSums& sums) {
    sums = DensityJobSums{};
    if (job.row_stride == 4) {
        sum_points<true>(job, sums);
    } else {
        sum_points<false>(job, sums);
    }
}

}  // namespace tact

#endif
