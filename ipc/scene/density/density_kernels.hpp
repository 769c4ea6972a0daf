// The inner loop of DensityMap::sum(), one function per instruction set. Private to ipc/scene/density and its tests.
//
// Plain C types only: a translation unit compiled for a newer processor must not emit inline functions that
// the linker could use on an older one.
//
// Layout   rows of four floats along x, consecutive along y, so that the 4 x 4 coefficients that a point
//          needs in one z plane are 64 consecutive bytes, or two such blocks. Row r at y and z starts at z
//          * plane_stride + r * row_stride + 4 y:
//          columns  row r has x = 4 r .. 4 r + 3, so every coefficient is stored once. Four x that start at
//                   4 r + p are the last 4 - p of row r and the first p of row r + 1.
//          windows  row r has x = r .. r + 3: four times the memory, half the cache lines per point.
//          The memory after the last row has room for one more row: kernels read it without using it.
// Thread   any; no allocation, constant time per point
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
    float* gradient[3];    // null, or receives w grad rho of each point, per metre, model axes
    float rotation[9];     // row major, body to model
    float per_spacing[3];  // 1 / voxel, per metre
    // The body's origin in padded voxels is cell + fraction. Separate values keep the precision of a
    // point's position within its voxel, independently of the map's size.
    std::int32_t cell[3];
    float fraction[3];
    // Points are clamped to this range, relative to cell, where all coefficients are zero. Whole numbers.
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
    void (*sum)(const DensityJob&, DensityJobSums&);  // overwrites the sums
};

// Fastest first; the last, "generic", runs everywhere.
extern const DensityKernel kDensityKernels[];
extern const std::size_t kDensityKernelCount;

void density_sum_generic(const DensityJob& job, DensityJobSums& sums);
#if defined(__x86_64__)
void density_sum_avx2(const DensityJob& job, DensityJobSums& sums);
void density_sum_avx512(const DensityJob& job, DensityJobSums& sums);
#endif

// Single-precision partial sums are added to double sums after this many points.
inline constexpr std::size_t kDensityFlush = 512;

}  // namespace tact
