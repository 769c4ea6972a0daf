// Eight triangles at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "ipc/assets/triangle_look.hpp"

#define TACT_LANES 8
#define TACT_LANE __attribute__((target("avx2,fma"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(32)]] = float;
using I [[gnu::vector_size(32)]] = std::int32_t;

TACT_LANE F root(const F& v) { return _mm256_sqrt_ps(v); }
TACT_LANE F gather(const float* from, const I& at) {
    return _mm256_i32gather_ps(from, reinterpret_cast<const __m256i&>(at), 4);
}
TACT_LANE I gather(const std::uint32_t* from, const I& at) {
    return reinterpret_cast<I>(
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<const __m256i&>(at), 4));
}
TACT_LANE std::uint32_t bits(const I& mask) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<F>(mask)));
}

#include "ipc/assets/triangle_look_lanes.hpp"

}  // namespace

__attribute__((target("avx2,fma"))) void look_avx2(const LookJob& job, TriangleLooks& out) {
    look_at_all(job, out);
}

}  // namespace tact

#endif
