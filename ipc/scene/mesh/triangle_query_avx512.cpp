// Sixteen triangles at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "ipc/scene/mesh/triangle_query.hpp"

#define TACT_LANES 16
#define TACT_LANE __attribute__((target("avx512f"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(64)]] = float;
using I [[gnu::vector_size(64)]] = std::int32_t;

TACT_LANE F root(const F& v) { return _mm512_maskz_sqrt_ps(0xFFFF, v); }
// Loads single vertices and transposes them: a gather of as many lanes takes five to ten times as long.
using F4 [[gnu::vector_size(16)]] = float;
TACT_LANE F4 point(const float* position, const std::uint32_t* corner, std::uint32_t triangle) {
    // Three floats: the fourth may be beyond the end of the array.
    return _mm_maskload_ps(position + std::size_t{3} * corner[std::size_t{3} * triangle],
                           _mm_set_epi32(0, -1, -1, -1));
}
using F8 [[gnu::vector_size(32)]] = float;
TACT_LANE F8 pair(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle) {
    return __builtin_shufflevector(point(position, corner, triangle[0]), point(position, corner, triangle[4]),
                                   0, 1, 2, 3, 4, 5, 6, 7);
}
TACT_LANE F four(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle) {
    return __builtin_shufflevector(pair(position, corner, triangle), pair(position, corner, triangle + 8), 0,
                                   1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
// In each quarter of a and b: interleaves the first two; the last two; joins the first halves; the second halves.
TACT_LANE F first_by_turns(const F& a, const F& b) {
    return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
TACT_LANE F last_by_turns(const F& a, const F& b) {
    return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
TACT_LANE F first_halves(const F& a, const F& b) {
    return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}
TACT_LANE F second_halves(const F& a, const F& b) {
    return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}
TACT_LANE void points(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle, F& x,
                      F& y, F& z) {
    const F p = four(position, corner, triangle), q = four(position, corner, triangle + 1),
            r = four(position, corner, triangle + 2), s = four(position, corner, triangle + 3);
    const F pq = first_by_turns(p, q), rs = first_by_turns(r, s);
    x = first_halves(pq, rs);
    y = second_halves(pq, rs);
    z = first_halves(last_by_turns(p, q), last_by_turns(r, s));
}
TACT_LANE std::uint32_t bits(const I& mask) {
    const auto& m = reinterpret_cast<const __m512i&>(mask);
    return _mm512_test_epi32_mask(m, m);
}

#include "ipc/scene/mesh/triangle_query_lanes.hpp"

}  // namespace

__attribute__((target("avx512f"))) void query_avx512(const QueryJob& job, TriangleQueries& out) {
    look_at_all(job, out);
}

}  // namespace tact

#endif
