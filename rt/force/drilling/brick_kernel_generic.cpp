// Four voxels at a time: two instructions' worth on every x86-64, plain arithmetic elsewhere.
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <cmath>
#include <cstring>

#include "rt/force/drilling/brick_kernels.hpp"

#define TACT_LANES 4
#define TACT_LANE inline

namespace tact {
namespace {

using F [[gnu::vector_size(16)]] = float;
using I [[gnu::vector_size(16)]] = std::int32_t;
using U [[gnu::vector_size(16)]] = std::uint32_t;

F root(const F& v) {
#if defined(__SSE2__)
    return _mm_sqrt_ps(v);  // g++ makes four calls of the other, for the sake of errno
#else
    return F{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
bool any(const I& mask) { return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0; }

I levels_at(const std::uint8_t* from) {
#if defined(__SSE2__)
    std::int32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    const __m128i none = _mm_setzero_si128();
    return reinterpret_cast<I>(_mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(word), none), none));
#else
    return I{from[0], from[1], from[2], from[3]};
#endif
}
void set_levels(const I& levels, std::uint8_t* to) {
#if defined(__SSE2__)
    const __m128i words =
        _mm_packs_epi32(reinterpret_cast<__m128i>(levels), reinterpret_cast<__m128i>(levels));
    const std::int32_t word = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
    std::memcpy(to, &word, sizeof word);
#else
    for (int i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(levels[i]);
#endif
}

#include "rt/force/drilling/brick_kernel_lanes.hpp"

bool always() { return true; }
#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
bool has_avx512() { return has_avx2() && __builtin_cpu_supports("avx512f") != 0; }
#endif

}  // namespace

void brick_sum_generic(const SumJob& job, const std::uint8_t* voxels, BrickSums& out) {
    sum_brick(job, voxels, out);
}
std::uint32_t brick_erode_generic(const ErodeJob& job, std::uint8_t* voxels) {
    return erode_brick(job, voxels);
}
void brick_cut_generic(CutBlocks& blocks) { cut_blocks(blocks); }

const BrickKernels kBrickKernels[] = {
#if defined(__x86_64__)
    {"avx512", &has_avx512, &brick_sum_avx512, &brick_erode_avx512, &brick_cut_avx512},
    {"avx2", &has_avx2, &brick_sum_avx2, &brick_erode_avx2, &brick_cut_avx2},
#endif
    {"generic", &always, &brick_sum_generic, &brick_erode_generic, &brick_cut_generic},
};
const std::size_t kBrickKernelCount = sizeof(kBrickKernels) / sizeof(kBrickKernels[0]);

const BrickKernels& best_brick_kernels() {
    const BrickKernels* kernels = kBrickKernels;
    while (!kernels->runs_here()) ++kernels;  // the last one runs everywhere
    return *kernels;
}

}  // namespace tact
