// Four triangles at a time: SSE on every x86-64, plain arithmetic elsewhere.
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <cmath>

#include "ipc/scene/mesh/triangle_query.hpp"

#define TACT_LANES 4
#define TACT_LANE inline

namespace tact {
namespace {

using F [[gnu::vector_size(16)]] = float;
using I [[gnu::vector_size(16)]] = std::int32_t;

F root(const F& v) {
#if defined(__SSE__)
    return _mm_sqrt_ps(v);  // for the other form, g++ emits four calls because of errno
#else
    return F{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
void points(const float* position, const std::uint32_t* corner, const std::uint32_t* triangle, F& x, F& y,
            F& z) {
    const auto of = [&](int lane) {
        return position + std::size_t{3} * corner[std::size_t{3} * triangle[lane]];
    };
    const float *const p = of(0), *const q = of(1), *const r = of(2), *const s = of(3);
    x = F{p[0], q[0], r[0], s[0]};
    y = F{p[1], q[1], r[1], s[1]};
    z = F{p[2], q[2], r[2], s[2]};
}
std::uint32_t bits(const I& mask) {
    return (static_cast<std::uint32_t>(mask[0]) & 1U) | (static_cast<std::uint32_t>(mask[1]) & 2U) |
           (static_cast<std::uint32_t>(mask[2]) & 4U) | (static_cast<std::uint32_t>(mask[3]) & 8U);
}

#include "ipc/scene/mesh/triangle_query_lanes.hpp"

bool always() { return true; }
#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }
bool has_avx512() { return has_avx2() && __builtin_cpu_supports("avx512f") != 0; }
#endif

}  // namespace

void query_four(const QueryJob& job, TriangleQueries& out) {
    out.over = 0;
    out.near = 0;
    look_at(job, 0, out);
}

void query_generic(const QueryJob& job, TriangleQueries& out) { look_at_all(job, out); }

const QueryKernel kQueryKernels[] = {
#if defined(__x86_64__)
    {"avx512", &has_avx512, &query_avx512},
    {"avx2", &has_avx2, &query_avx2},
#endif
    {"generic", &always, &query_generic},
};
const std::size_t kQueryKernelCount = sizeof(kQueryKernels) / sizeof(kQueryKernels[0]);

const QueryKernel& best_query_kernel() {
    const QueryKernel* kernel = kQueryKernels;
    while (!kernel->runs_here()) ++kernel;  // the last one runs everywhere
    return *kernel;
}

}  // namespace tact
