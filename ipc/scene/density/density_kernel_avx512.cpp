// Density kernel for AVX-512 (F only).
//
// Processes sixteen points at a time. Their positions and spline weights are computed in
// structure-of-arrays form. Then, for four points at a time, each point's 64 coefficients are summed along
// z, with one weight for a whole 4 y x 4 x; the results of the four are transposed to 4 y x 4 points and
// summed along x. The sums of all sixteen are transposed once more, to sixteen points, and summed along y.
// So only loads broadcast a weight over a vector, and the remaining work per point, weight and lever arm,
// is done for sixteen at once.
//
// With coefficients in columns, a patch takes two loads; the second replaces the elements of the first that
// are before the patch. This rotates x within its four, by the same amount for all rows of a point; the
// weights along x are rotated to match, and the rest of the computation is unchanged.
//
// The code computes six times the spline's weights and twice its slopes, per voxel; the final sums correct
// the factors.
#if defined(__x86_64__)

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns about deliberately undefined registers in its own header (bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>

#include "ipc/scene/density/density_kernels.hpp"

#define TACT_AVX512 __attribute__((target("avx512f,avx2,fma")))

namespace tact {

namespace {

constexpr int kLanes = 16;
// Prefetch distance for points, bypassing the caches in which the map should stay.
constexpr std::ptrdiff_t kFetchAhead = 128;
constexpr double kValueScale = 1.0 / (6.0 * 6.0 * 6.0), kSlopeScale = 1.0 / (2.0 * 6.0 * 6.0);

struct alignas(64) Block {
    float value_z[4][kLanes], slope_z[4][kLanes], value_x[4][kLanes], slope_x[4][kLanes];
    __m512 value_y[4], slope_y[4];
    __m512 r[3], weight;
    std::int32_t offset[kLanes];
    std::int32_t second[kLanes];  // columns: mask of the elements from the second row
};

struct Weights {
    __m512 value[4], slope[4];
};

TACT_AVX512 inline Weights weights(__m512 f) {
    const __m512 three = _mm512_set1_ps(3.0F), four = _mm512_set1_ps(4.0F), six = _mm512_set1_ps(6.0F);
    const __m512 g = _mm512_sub_ps(_mm512_set1_ps(1.0F), f);
    const __m512 ff = _mm512_mul_ps(f, f), gg = _mm512_mul_ps(g, g);
    Weights w;
    w.value[0] = _mm512_mul_ps(gg, g);
    w.value[1] = _mm512_fmadd_ps(ff, _mm512_fmsub_ps(three, f, six), four);
    w.value[2] = _mm512_fmadd_ps(gg, _mm512_fmsub_ps(three, g, six), four);
    w.value[3] = _mm512_mul_ps(ff, f);
    w.slope[0] = _mm512_sub_ps(_mm512_setzero_ps(), gg);
    w.slope[1] = _mm512_mul_ps(f, _mm512_fmsub_ps(three, f, four));
    w.slope[2] = _mm512_mul_ps(g, _mm512_fnmadd_ps(three, g, four));
    w.slope[3] = ff;
    return w;
}

// Rotates each weight to the position of its coefficient: w[(e - cell) mod 4] to e.
TACT_AVX512 inline void rotate(__m512i cell, __m512* w) {
    const __mmask16 by_one = _mm512_test_epi32_mask(cell, _mm512_set1_epi32(1));
    const __mmask16 by_two = _mm512_test_epi32_mask(cell, _mm512_set1_epi32(2));
    const __m512 a[4] = {_mm512_mask_mov_ps(w[0], by_one, w[3]), _mm512_mask_mov_ps(w[1], by_one, w[0]),
                         _mm512_mask_mov_ps(w[2], by_one, w[1]), _mm512_mask_mov_ps(w[3], by_one, w[2])};
    for (int e = 0; e < 4; ++e) w[e] = _mm512_mask_mov_ps(a[e], by_two, a[e ^ 2]);
}

// Prefetching any address is safe, also beyond the last point.
TACT_AVX512 inline void fetch(const float* next) {
    _mm_prefetch(reinterpret_cast<const char*>(next) + 4 * kFetchAhead, _MM_HINT_NTA);
}

template <bool windows>
TACT_AVX512 inline void prepare(const DensityJob& job, std::size_t begin, std::size_t count, Block& block) {
    // Points beyond the last get zero weight and the body's origin as position.
    const __mmask16 mask = count >= kLanes ? __mmask16{0xFFFF} : static_cast<__mmask16>((1U << count) - 1U);
    const __m512 x = _mm512_maskz_loadu_ps(mask, job.x + begin);
    const __m512 y = _mm512_maskz_loadu_ps(mask, job.y + begin);
    const __m512 z = _mm512_maskz_loadu_ps(mask, job.z + begin);
    block.weight = _mm512_maskz_loadu_ps(mask, job.weight + begin);
    if constexpr (!windows) {
        fetch(job.x + begin);
        fetch(job.y + begin);
        fetch(job.z + begin);
        fetch(job.weight + begin);
    }
    __m512i offset = _mm512_setzero_si512();
    for (int a = 0; a < 3; ++a) {
        const float* row = job.rotation + 3 * a;
        __m512 r = _mm512_mul_ps(_mm512_set1_ps(row[0]), x);
        r = _mm512_fmadd_ps(_mm512_set1_ps(row[1]), y, r);
        r = _mm512_fmadd_ps(_mm512_set1_ps(row[2]), z, r);
        block.r[a] = r;
        __m512 t = _mm512_fmadd_ps(r, _mm512_set1_ps(job.per_spacing[a]), _mm512_set1_ps(job.fraction[a]));
        t = _mm512_max_ps(t, _mm512_set1_ps(job.low[a]));  // returns the second operand for NaN
        t = _mm512_min_ps(t, _mm512_set1_ps(job.high[a]));
        const __m512i whole = _mm512_cvt_roundps_epi32(t, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
        Weights w = weights(_mm512_sub_ps(t, _mm512_cvtepi32_ps(whole)));
        __m512i cell = _mm512_add_epi32(whole, _mm512_set1_epi32(job.cell[a] - 1));
        if (a == 0) {
            if constexpr (!windows) {
                rotate(cell, w.value);
                rotate(cell, w.slope);
                const __m512i masks = _mm512_set4_epi32(0x7777, 0x3333, 0x1111, 0);
                _mm512_store_ps(block.second, _mm512_permutevar_ps(_mm512_castsi512_ps(masks), cell));
                cell = _mm512_srli_epi32(cell, 2);
            }
            offset = _mm512_mullo_epi32(cell, _mm512_set1_epi32(job.row_stride));
        } else if (a == 1) {
            offset = _mm512_add_epi32(offset, _mm512_slli_epi32(cell, 2));
        } else {
            cell = _mm512_mullo_epi32(cell, _mm512_set1_epi32(job.plane_stride));
            offset = _mm512_add_epi32(offset, cell);
        }
        for (int k = 0; k < 4; ++k) {
            if (a == 1) {
                block.value_y[k] = w.value[k];
                block.slope_y[k] = w.slope[k];
            } else {
                _mm512_store_ps(a == 0 ? block.value_x[k] : block.value_z[k], w.value[k]);
                _mm512_store_ps(a == 0 ? block.slope_x[k] : block.slope_z[k], w.slope[k]);
            }
        }
    }
    _mm512_store_si512(block.offset, offset);
}

// Element l of lane j of out[e] is element e of lane j of v[l].
TACT_AVX512 inline void transpose_in_lanes(const __m512* v, __m512* out) {
    const __m512 a = _mm512_unpacklo_ps(v[0], v[1]), b = _mm512_unpackhi_ps(v[0], v[1]);
    const __m512 c = _mm512_unpacklo_ps(v[2], v[3]), d = _mm512_unpackhi_ps(v[2], v[3]);
    out[0] = _mm512_shuffle_ps(a, c, 0x44);
    out[1] = _mm512_shuffle_ps(a, c, 0xEE);
    out[2] = _mm512_shuffle_ps(b, d, 0x44);
    out[3] = _mm512_shuffle_ps(b, d, 0xEE);
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

// Four rows of four x.
template <bool windows>
TACT_AVX512 inline __m512 load_patch(const float* p, std::ptrdiff_t row_stride, __mmask16 second) {
    const __m512 rows = _mm512_loadu_ps(p);
    if constexpr (windows) return rows;
    return _mm512_mask_loadu_ps(rows, second, p + row_stride);
}

TACT_AVX512 inline __m512 in_all_lanes(const float* four) {
    return _mm512_broadcast_f32x4(_mm_load_ps(four));
}

TACT_AVX512 inline __m512 dot(const __m512* a, const __m512* b) {
    __m512 sum = _mm512_mul_ps(a[0], b[0]);
    sum = _mm512_fmadd_ps(a[1], b[1], sum);
    sum = _mm512_fmadd_ps(a[2], b[2], sum);
    return _mm512_fmadd_ps(a[3], b[3], sum);
}

// Sums along z and x, as 4 y x 4 points: of the density and of its slopes along x and z.
struct Rows {
    __m512 value[4], slope_x[4], slope_z[4];
};

// Points 4 m .. 4 m + 3 of the block.
template <bool windows, int m>
TACT_AVX512 inline void sum_four(const DensityJob& job, const Block& block, Rows& rows) {
    const std::ptrdiff_t plane_stride = job.plane_stride, row_stride = job.row_stride;
    __m512 planes[4], rises[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; ++l) {
        const int i = 4 * m + l;
        const float* const p = job.coefficients + block.offset[i];
        const __mmask16 second = windows ? __mmask16{0} : static_cast<__mmask16>(block.second[i]);
        __m512 c = load_patch<windows>(p, row_stride, second);
        __m512 plane = _mm512_mul_ps(c, _mm512_set1_ps(block.value_z[0][i]));
        __m512 rise = _mm512_mul_ps(c, _mm512_set1_ps(block.slope_z[0][i]));
#pragma GCC unroll 3
        for (int z = 1; z < 4; ++z) {
            c = load_patch<windows>(p + z * plane_stride, row_stride, second);
            plane = _mm512_fmadd_ps(c, _mm512_set1_ps(block.value_z[z][i]), plane);
            rise = _mm512_fmadd_ps(c, _mm512_set1_ps(block.slope_z[z][i]), rise);
        }
        planes[l] = plane;
        rises[l] = rise;
    }
    __m512 plane_x[4], rise_x[4];
    transpose_in_lanes(planes, plane_x);
    transpose_in_lanes(rises, rise_x);
    __m512 value = in_all_lanes(block.value_x[0] + 4 * m);
    rows.value[m] = _mm512_mul_ps(plane_x[0], value);
    rows.slope_z[m] = _mm512_mul_ps(rise_x[0], value);
    rows.slope_x[m] = _mm512_mul_ps(plane_x[0], in_all_lanes(block.slope_x[0] + 4 * m));
#pragma GCC unroll 3
    for (int e = 1; e < 4; ++e) {
        value = in_all_lanes(block.value_x[e] + 4 * m);
        rows.value[m] = _mm512_fmadd_ps(plane_x[e], value, rows.value[m]);
        rows.slope_z[m] = _mm512_fmadd_ps(rise_x[e], value, rows.slope_z[m]);
        const __m512 slope = in_all_lanes(block.slope_x[e] + 4 * m);
        rows.slope_x[m] = _mm512_fmadd_ps(plane_x[e], slope, rows.slope_x[m]);
    }
}

struct Accumulators {
    __m512 density, gx, gy, gz, mx, my, mz;
};

template <bool windows>
TACT_AVX512 inline void add_block(const DensityJob& job, const Block& block, std::size_t begin,
                                  Accumulators& sum) {
    Rows rows;
    sum_four<windows, 0>(job, block, rows);
    sum_four<windows, 1>(job, block, rows);
    sum_four<windows, 2>(job, block, rows);
    sum_four<windows, 3>(job, block, rows);
    __m512 row_y[4], per_spacing[3];
    for (int a = 0; a < 3; ++a)
        per_spacing[a] = _mm512_mul_ps(block.weight, _mm512_set1_ps(job.per_spacing[a]));
    transpose_lanes(rows.value, row_y);
    sum.density = _mm512_fmadd_ps(dot(row_y, block.value_y), block.weight, sum.density);
    const __m512 py = _mm512_mul_ps(dot(row_y, block.slope_y), per_spacing[1]);
    transpose_lanes(rows.slope_x, row_y);
    const __m512 px = _mm512_mul_ps(dot(row_y, block.value_y), per_spacing[0]);
    transpose_lanes(rows.slope_z, row_y);
    const __m512 pz = _mm512_mul_ps(dot(row_y, block.value_y), per_spacing[2]);
    if (job.gradient[0] != nullptr) {
        const std::size_t left = job.count - begin;
        const auto mask = static_cast<__mmask16>(left < std::size_t{kLanes} ? (1U << left) - 1U : 0xFFFFU);
        const __m512 scale = _mm512_set1_ps(static_cast<float>(kSlopeScale));
        _mm512_mask_storeu_ps(job.gradient[0] + begin, mask, _mm512_mul_ps(px, scale));
        _mm512_mask_storeu_ps(job.gradient[1] + begin, mask, _mm512_mul_ps(py, scale));
        _mm512_mask_storeu_ps(job.gradient[2] + begin, mask, _mm512_mul_ps(pz, scale));
    }
    const __m512 rx = block.r[0], ry = block.r[1], rz = block.r[2];
    sum.gx = _mm512_add_ps(sum.gx, px);
    sum.gy = _mm512_add_ps(sum.gy, py);
    sum.gz = _mm512_add_ps(sum.gz, pz);
    sum.mx = _mm512_fnmadd_ps(rz, py, _mm512_fmadd_ps(ry, pz, sum.mx));
    sum.my = _mm512_fnmadd_ps(rx, pz, _mm512_fmadd_ps(rz, px, sum.my));
    sum.mz = _mm512_fnmadd_ps(ry, px, _mm512_fmadd_ps(rx, py, sum.mz));
}

TACT_AVX512 inline double total(__m512 v) {
    const __m256 high = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(v), 1));
    return _mm512_reduce_add_pd(
        _mm512_add_pd(_mm512_cvtps_pd(_mm512_castps512_ps256(v)), _mm512_cvtps_pd(high)));
}

template <bool windows>
TACT_AVX512 void sum_points(const DensityJob& job, DensityJobSums& sums) {
    Block blocks[2];  // one is prepared while the other is summed
    Block *now = blocks, *next = blocks + 1;
    for (std::size_t first = 0; first < job.count; first += kDensityFlush) {
        const std::size_t end = job.count - first < kDensityFlush ? job.count : first + kDensityFlush;
        const __m512 zero = _mm512_setzero_ps();
        Accumulators sum{zero, zero, zero, zero, zero, zero, zero};
        prepare<windows>(job, first, end - first, *now);
        for (std::size_t begin = first; begin < end; begin += kLanes) {
            if (begin + kLanes < end) prepare<windows>(job, begin + kLanes, end - begin - kLanes, *next);
            add_block<windows>(job, *now, begin, sum);
            Block* const used = now;
            now = next;
            next = used;
        }
        sums.density += kValueScale * total(sum.density);
        sums.gradient[0] += kSlopeScale * total(sum.gx);
        sums.gradient[1] += kSlopeScale * total(sum.gy);
        sums.gradient[2] += kSlopeScale * total(sum.gz);
        sums.moment[0] += kSlopeScale * total(sum.mx);
        sums.moment[1] += kSlopeScale * total(sum.my);
        sums.moment[2] += kSlopeScale * total(sum.mz);
    }
}

}  // namespace

TACT_AVX512 void density_sum_avx512(const DensityJob& job, DensityJobSums& sums) {
    sums = DensityJobSums{};
    if (job.windows) {
        sum_points<true>(job, sums);
    } else {
        sum_points<false>(job, sums);
    }
}

}  // namespace tact

#endif
