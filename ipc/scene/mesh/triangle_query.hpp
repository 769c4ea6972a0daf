// How sixteen triangles lie to a point, looked at together: one function per instruction set.
//
// Plain C types only: a translation unit that is compiled for a newer processor must not emit inline
// functions that the linker could pick for an older one.
//
// Method   one triangle a lane, without a branch: its nearest point is that of its three edges, or the foot on
//          its plane where that lies inside. (A walk through the regions, one triangle after the other,
//          mispredicts half of its branches.)
// Unit     those of the positions; single precision about the point: right to some 1e-7 of the triangle's size
// Thread   any; no allocation, constant time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

inline constexpr std::size_t kLooks = 16;

struct QueryJob {
    const float* position;          // 3 a vertex
    const std::uint32_t* corner;    // 3 a triangle
    const std::uint32_t* triangle;  // kLooks of them; any more than once
    // The point as a sum of two singles: what is left of a corner near it after the first is exact.
    float whole[3], rest[3];
    float limit;  // of `near`
};

// Of each lane. Arrays of three are [axis].
struct alignas(64) TriangleQueries {
    float distance[kLooks];
    float away[3][kLooks];   // unit, from the nearest point to the point; shorter within 1e-18 of it
    float facet[3][kLooks];  // unit normal of its plane, on the point's side; `away` of needles and points
    float height[kLooks];    // over that plane; the distance of needles and points
    std::uint32_t over;      // bits, of lanes whose nearest point lies inside the triangle
    std::uint32_t near;      // bits, of lanes whose distance is below the limit
};

struct QueryKernel {
    const char* name;
    bool (*runs_here)();
    void (*query)(const QueryJob&, TriangleQueries&);
};

// Fastest first; the last, "generic", runs everywhere.
extern const QueryKernel kQueryKernels[];
extern const std::size_t kQueryKernelCount;
[[nodiscard]] const QueryKernel& best_query_kernel();

// The first four only.
void query_four(const QueryJob& job, TriangleQueries& out);

void query_generic(const QueryJob& job, TriangleQueries& out);
#if defined(__x86_64__)
void query_avx2(const QueryJob& job, TriangleQueries& out);
void query_avx512(const QueryJob& job, TriangleQueries& out);
#endif

}  // namespace tact
