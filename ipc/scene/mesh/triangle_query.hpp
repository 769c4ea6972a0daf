// Relation of sixteen triangles to a point, computed together: one function per instruction set.
//
// Plain C types only: a translation unit compiled for a newer processor must not emit inline functions that
// the linker could use on an older one.
//
// Method   one triangle per lane, branch-free: the nearest point is that of its three edges, or the foot on
//          its plane if that is inside. (A branch per region, one triangle after the other, is mispredicted
//          half of the time.)
// Unit     those of the positions; single precision relative to the point: accurate to about 1e-7 of the
//          triangle's size
// Thread   any; no allocation, constant time
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

inline constexpr std::size_t kLooks = 16;

struct QueryJob {
    const float* position;          // 3 per vertex
    const std::uint32_t* corner;    // 3 per triangle
    const std::uint32_t* triangle;  // kLooks triangles; repetitions are allowed
    // The point as a sum of two floats: the difference of a nearby corner and the first is exact.
    float whole[3], rest[3];
    float limit;  // for `near`
};

// Per lane. Arrays of three are [axis].
struct alignas(64) TriangleQueries {
    float distance[kLooks];
    float away[3][kLooks];   // unit vector from the nearest point to the point; shorter within 1e-18 of it
    float facet[3][kLooks];  // unit normal of its plane, towards the point; `away` for needles and points
    float height[kLooks];    // above that plane; the distance for needles and points
    std::uint32_t over;      // bits of lanes whose nearest point is inside the triangle
    std::uint32_t near;      // bits of lanes whose distance is below the limit
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

// For the first four triangles only.
void query_four(const QueryJob& job, TriangleQueries& out);

void query_generic(const QueryJob& job, TriangleQueries& out);
#if defined(__x86_64__)
void query_avx2(const QueryJob& job, TriangleQueries& out);
void query_avx512(const QueryJob& job, TriangleQueries& out);
#endif

}  // namespace tact
