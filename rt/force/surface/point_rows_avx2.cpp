// Eight points at a time.
#if defined(__x86_64__)

#include <immintrin.h>

#include "rt/force/surface/point_rows.hpp"

#define TACT_LANES 8
#define TACT_LANE __attribute__((target("avx2"), always_inline)) inline

namespace tact {
namespace {

using F [[gnu::vector_size(32)]] = float;
using I [[gnu::vector_size(32)]] = std::int32_t;

TACT_LANE F root(const F& v) { return _mm256_sqrt_ps(v); }
TACT_LANE std::uint32_t bits(const I& mask) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<F>(mask)));
}

#include "rt/force/surface/point_rows_lanes.hpp"

}  // namespace

__attribute__((target("avx2"))) void point_rooms_avx2(const PointRooms& job) { find_rooms(job); }
__attribute__((target("avx2"))) std::uint64_t points_beyond_avx2(const PointsBeyond& job, std::size_t first) {
    return find_beyond(job, first);
}

}  // namespace tact

#endif
