// The inner loop of DensityMap::sum(), one function per instruction set. Private to ipc/assets and its tests.
//
// Plain C types only: a translation unit that is compiled for a newer processor must not emit inline
// functions that the linker could pick for an older one.
//
// Layout   rows of four floats along x, one behind the other along y, so that what a point needs of one z
//          plane, 4 x 4 coefficients, is 64 bytes in a row or two times that. Row r at y and z begins at
//          z * plane_stride + r * row_stride + 4 y:
//          columns  row r has x = 4 r .. 4 r + 3, so every coefficient is stored once. Four x that begin at
//                   4 r + p are the last 4 - p of row r and the first p of row r + 1.
//          windows  row r has x = r .. r + 3: four times the memory, half the cache lines for a point.
//          Behind the last row there is room for one more: kernels read it and do not use it.
// Thread   any; no allocation, constant time per point.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

struct DensityJob {
    const float* coefficients;
    bool windows;                           // or columns
    std::int32_t row_stride, plane_stride;  // in floats
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
