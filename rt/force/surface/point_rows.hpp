// The arithmetic on all points of a tool at once: one function per instruction set, with bit-equal results.
//
// Plain C types only: a translation unit compiled for a newer processor must not emit inline functions that
// the linker could use on an older one. No multiplication is joined with an addition (-ffp-contract=off).
//
// Unit     those of the rows.  Thread  any; no allocation.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

inline constexpr std::size_t kPointBlock = 64;  // rows have a multiple of this

// Levers in the turned frame, and the displacement that is free: bound - |lever + hand - asked| - taken, at least zero; 1e30 for a
// negative bound.
struct PointRooms {
    const float* local[3];
    const float* asked[3];
    const float* bound;
    float* lever[3];
    float* room;
    std::size_t count;  // a multiple of kPointBlock
    float turn[3][3];   // [row][column]
    float hand[3], taken;
};

// Of kPointBlock points from `first` on: those whose displacement v + w x lever exceeds the root of part times their room.
struct PointsBeyond {
    const float* lever[3];
    const float* room;
    float v[3], w[3], part;
};

struct PointKernels {
    const char* name;
    bool (*runs_here)();
    void (*rooms)(const PointRooms&);
    std::uint64_t (*beyond)(const PointsBeyond&, std::size_t first);
};

// Fastest first; the last, "generic", runs everywhere.
extern const PointKernels kPointKernels[];
extern const std::size_t kPointKernelCount;
[[nodiscard]] const PointKernels& best_point_kernels();

void point_rooms_generic(const PointRooms& job);
std::uint64_t points_beyond_generic(const PointsBeyond& job, std::size_t first);
#if defined(__x86_64__)
void point_rooms_avx2(const PointRooms& job);
std::uint64_t points_beyond_avx2(const PointsBeyond& job, std::size_t first);
void point_rooms_avx512(const PointRooms& job);
std::uint64_t points_beyond_avx512(const PointsBeyond& job, std::size_t first);
#endif

}  // namespace tact
