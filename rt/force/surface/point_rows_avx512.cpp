// Sixteen points at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "rt/force/surface/point_rows.hpp"

#define TACT_LANES 16
#define TACT_LANE __attribute__((target("avx512f"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(64)]] = float;
using I [[gnu::vector_size(64)]] = std::int32_t;

// With a mask: g++ 12 warns of the source that the plain one leaves undefined.
TACT_LANE F root(const F& v) { return _mm512_maskz_sqrt_ps(0xFFFF, v); }
TACT_LANE std::uint32_t bits(const I& mask) {
    const auto& m = reinterpret_cast<const __m512i&>(mask);
    return _mm512_test_epi32_mask(m, m);
}

#include "rt/force/surface/point_rows_lanes.hpp"

}  // namespace

__attribute__((target("avx512f"))) void point_rooms_avx512(const PointRooms& job) { find_rooms(job); }
__attribute__((target("avx512f"))) std::uint64_t points_beyond_avx512(const PointsBeyond& job,
                                                                      std::size_t first) {
    return find_beyond(job, first);
}

}  // namespace tact

#endif
