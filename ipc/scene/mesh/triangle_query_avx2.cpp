// Eight triangles at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "ipc/scene/mesh/triangle_query.hpp"

#define TACT_LANES 8
#define TACT_LANE __attribute__((target("avx2,fma"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(32)]] = float;
using I [[gnu::vector_size(32)]] = std::int32_t;

TACT_LANE F root(const F& v) { return _mm256_sqrt_ps(v); }
// Loads single vertices and transposes them: a gather of as many lanes takes five to ten times as long.
using F4 [[gnu::vector_size(16)]] = float;
TACT_LANE F4 point(const float* position, const std::uint32_t* corner, std::uint32_t triangle) {
    // Three floats: the fourth may be beyond the end of the array.
    return _mm_maskload_ps(position + std::size_t{3} * corner[std::size_t{3} * triangle],
                           _mm_set_epi32(0, -1, -1, -1));
}
TACT_LANE F pair(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle) {
    return __builtin_shufflevector(point(position, corner, triangle[0]), point(position, corner, triangle[4]),
                                   0, 1, 2, 3, 4, 5, 6, 7);
}
TACT_LANE void points(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle, F& x,
                      F& y, F& z) {
    const F p = pair(position, corner, triangle), q = pair(position, corner, triangle + 1),
            r = pair(position, corner, triangle + 2), s = pair(position, corner, triangle + 3);
    const F pq = __builtin_shufflevector(p, q, 0, 8, 1, 9, 4, 12, 5, 13),
            rs = __builtin_shufflevector(r, s, 0, 8, 1, 9, 4, 12, 5, 13);
    x = __builtin_shufflevector(pq, rs, 0, 1, 8, 9, 4, 5, 12, 13);
    y = __builtin_shufflevector(pq, rs, 2, 3, 10, 11, 6, 7, 14, 15);
    z = __builtin_shufflevector(__builtin_shufflevector(p, q, 2, 10, 3, 11, 6, 14, 7, 15),
                                __builtin_shufflevector(r, s, 2, 10, 3, 11, 6, 14, 7, 15), 0, 1, 8, 9, 4, 5,
                                12, 13);
}
TACT_LANE std::uint32_t bits(const I& mask) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<F>(mask)));
}

#include "ipc/scene/mesh/triangle_query_lanes.hpp"

}  // namespace

__attribute__((target("avx2,fma"))) void query_avx2(const QueryJob& job, TriangleQueries& out) {
    look_at_all(job, out);
}

}  // namespace tact

#endif
