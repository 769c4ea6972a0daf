// Sixteen voxels at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "rt/force/drilling/brick_kernels.hpp"

#define TACT_LANES 16
#define TACT_LANE __attribute__((target("avx512f"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(64)]] = float;
using I [[gnu::vector_size(64)]] = std::int32_t;
using U [[gnu::vector_size(64)]] = std::uint32_t;

TACT_LANE F root(const F& v) { return _mm512_maskz_sqrt_ps(0xFFFF, v); }
TACT_LANE bool any(const I& mask) {
    const auto& m = reinterpret_cast<const __m512i&>(mask);
    return _mm512_test_epi32_mask(m, m) != 0;
}

TACT_LANE I levels_at(const std::uint8_t* from) {
    // With a mask: g++ 12 warns of the source that the plain ones leave undefined.
    return reinterpret_cast<I>(
        _mm512_maskz_cvtepu8_epi32(0xFFFF, _mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
TACT_LANE void set_levels(const I& levels, std::uint8_t* to) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to),
                     _mm512_maskz_cvtepi32_epi8(0xFFFF, reinterpret_cast<__m512i>(levels)));
}

#include "rt/force/drilling/brick_kernel_lanes.hpp"

}  // namespace

__attribute__((target("avx512f"))) void brick_sum_avx512(const SumJob& job, const std::uint8_t* voxels,
                                                         BrickSums& out) {
    sum_brick(job, voxels, out);
}
__attribute__((target("avx512f"))) std::uint32_t brick_erode_avx512(const ErodeJob& job,
                                                                    std::uint8_t* voxels) {
    return erode_brick(job, voxels);
}
__attribute__((target("avx512f"))) void brick_cut_avx512(CutBlocks& blocks) { cut_blocks(blocks); }

}  // namespace tact

#endif
