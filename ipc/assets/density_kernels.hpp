// The inner loop of DensityMap::sum(), one function per instruction set. Private to ipc/assets and its tests.
//
// Plain C types only: a translation unit that is compiled for a newer processor must not emit inline
// functions that the linker could pick for an older one.
//
// Layout   coefficient c(x, y, z) of the padded grid lies at x * stride[0] + y * stride[1] + z * stride[2],
//          and so do c(x + 1 .. x + 3, y, z) in the three floats behind it. Two layouts satisfy this:
//          plain       stride (1, nx, nx ny), row_stride nx
//          interleaved stride (4 ny, 4, 4 nx ny), row_stride 4: every window of four x is stored, so the 4 x
//          4 patch
//                      that a point needs of one z plane is 64 bytes in a row; four times the memory.
// Thread   any; no allocation, constant time per point.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

struct DensityJob {
    const float* coefficients;
    std::int32_t stride[3];
    std::int32_t row_stride;
    // Points, body frame, metres, and their weights.
    const float *x, *y, *z, *weight;
    std::size_t count;
    float rotation[9];     // row major, body to model
    float per_spacing[3];  // 1 / voxel, per metre
    // The body's origin in padded voxels is cell + fraction. Kept apart, so that a point's place within its
    // voxel does not lose digits to the size of the map.
    std::int32_t cell[3];
    float fraction[3];
    // Points are clamped here, relative to cell, where all coefficients are zero. Whole numbers.
    float low[3], high[3];
};

struct DensityJobSums {
    double density;
    double gradient[3];  // per metre, model axes
    double moment[3];    // about the body's origin, model axes
};

struct DensityKernel {
    const char* name;
    bool (*runs_here)();
    void (*sum)(const DensityJob&, DensityJobSums&);  // adds nothing: writes
};

// Fastest first; the last, "generic", runs everywhere.
extern const DensityKernel kDensityKernels[];
extern const std::size_t kDensityKernelCount;

void density_sum_generic(const DensityJob& job, DensityJobSums& sums);
#if defined(__x86_64__)
void density_sum_avx2(const DensityJob& job, DensityJobSums& sums);
void density_sum_avx512(const DensityJob& job, DensityJobSums& sums);
#endif

// Single-precision partial sums are moved to double after this many points.
inline constexpr std::size_t kDensityFlush = 512;

}  // namespace tact
