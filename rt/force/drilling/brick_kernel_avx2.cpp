// Eight voxels at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "rt/force/drilling/brick_kernels.hpp"

#define TACT_LANES 8
#define TACT_LANE __attribute__((target("avx2"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(32)]] = float;
using I [[gnu::vector_size(32)]] = std::int32_t;
using U [[gnu::vector_size(32)]] = std::uint32_t;

TACT_LANE F root(const F& v) { return _mm256_sqrt_ps(v); }
TACT_LANE bool any(const I& mask) { return _mm256_movemask_ps(reinterpret_cast<F>(mask)) != 0; }

TACT_LANE I levels_at(const std::uint8_t* from) {
    return reinterpret_cast<I>(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
TACT_LANE void set_levels(const I& levels, std::uint8_t* to) {
    const __m256i v = reinterpret_cast<__m256i>(levels);
    const __m128i words = _mm_packs_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_packus_epi16(words, words));
}

#include "rt/force/drilling/brick_kernel_lanes.hpp"

}  // namespace

__attribute__((target("avx2"))) void brick_sum_avx2(const SumJob& job, const std::uint8_t* voxels,
                                                    BrickSums& out) {
    sum_brick(job, voxels, out);
}
__attribute__((target("avx2"))) std::uint32_t brick_erode_avx2(const ErodeJob& job, std::uint8_t* voxels) {
    return erode_brick(job, voxels);
}
__attribute__((target("avx2"))) void brick_cut_avx2(CutBlocks& blocks) { cut_blocks(blocks); }

}  // namespace tact

#endif
