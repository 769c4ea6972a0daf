// Four points at a time: two instructions' worth on every x86-64, plain arithmetic elsewhere.
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <cmath>

#include "rt/force/surface/point_rows.hpp"

#define TACT_LANES 4
#define TACT_LANE inline

namespace tact {
namespace {

using F [[gnu::vector_size(16)]] = float;
using I [[gnu::vector_size(16)]] = std::int32_t;

F root(const F& v) {
#if defined(__SSE2__)
    return _mm_sqrt_ps(v);  // g++ makes four calls of the other, for the sake of errno
#else
    return F{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
std::uint32_t bits(const I& mask) {
#if defined(__SSE2__)
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<F>(mask)));
#else
    std::uint32_t all = 0;
    for (std::uint32_t i = 0; i < 4; ++i) all |= (mask[i] != 0 ? 1U : 0U) << i;
    return all;
#endif
}

#include "rt/force/surface/point_rows_lanes.hpp"

bool runs_everywhere() { return true; }
#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
bool has_avx512() { return __builtin_cpu_supports("avx512f") != 0; }
#endif

}  // namespace

void point_rooms_generic(const PointRooms& job) { find_rooms(job); }
std::uint64_t points_beyond_generic(const PointsBeyond& job, std::size_t first) {
    return find_beyond(job, first);
}

const PointKernels kPointKernels[] = {
#if defined(__x86_64__)
    {"avx512", has_avx512, point_rooms_avx512, points_beyond_avx512},
    {"avx2", has_avx2, point_rooms_avx2, points_beyond_avx2},
#endif
    {"generic", runs_everywhere, point_rooms_generic, points_beyond_generic},
};
const std::size_t kPointKernelCount = sizeof kPointKernels / sizeof kPointKernels[0];

const PointKernels& best_point_kernels() {
    const PointKernels* kernels = kPointKernels;
    while (!kernels->runs_here()) ++kernels;
    return *kernels;
}

}  // namespace tact
