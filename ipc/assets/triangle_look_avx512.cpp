// Sixteen triangles at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "ipc/assets/triangle_look.hpp"

#define TACT_LANES 16
#define TACT_LANE __attribute__((target("avx512f"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(64)]] = float;
using I [[gnu::vector_size(64)]] = std::int32_t;

TACT_LANE F root(const F& v) { return _mm512_maskz_sqrt_ps(0xFFFF, v); }
// With a mask, as above: g++ 12 warns of the source that the plain ones leave undefined.
TACT_LANE F gather(const float* from, const I& at) {
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xFFFF, reinterpret_cast<const __m512i&>(at), from,
                                    4);
}
TACT_LANE I gather(const std::uint32_t* from, const I& at) {
    return reinterpret_cast<I>(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xFFFF,
                                                           reinterpret_cast<const __m512i&>(at), from, 4));
}
TACT_LANE std::uint32_t bits(const I& mask) {
    const auto& m = reinterpret_cast<const __m512i&>(mask);
    return _mm512_test_epi32_mask(m, m);
}

#include "ipc/assets/triangle_look_lanes.hpp"

}  // namespace

__attribute__((target("avx512f"))) void look_avx512(const LookJob& job, TriangleLooks& out) {
    look_at_all(job, out);
}

}  // namespace tact

#endif
