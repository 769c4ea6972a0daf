// What is done with the voxels of one brick, or with sixteen blocks at once: one set of functions per instruction set.
//
// Plain C types only: a translation unit that is compiled for a newer processor must not emit inline functions
// that the linker could pick for an older one.
//
// Equal     bit by bit in all sets, so that a run repeats on another machine: each voxel is a lane of its own,
//           sums are of integers, and no multiplication is joined with an addition (-ffp-contract=off).
// Unit      voxel edges; levels of 1/255 of solid bone. m1 of bricks is in half voxel edges about the brick's centre.
// Thread    any; no allocation, bounded time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

inline constexpr std::size_t kCuts = 16;

// How much of a brick lies in a ball: a voxel counts by a smooth ramp over its own width, which keeps the ball's
// volume right to the order (1 / radius)^4.
struct SumJob {
    float first[3];   // voxel (0, 0, 0) of the brick, from the ball's centre
    float limit;      // radius^2 - 1/12
    float per_width;  // 1 / (2 radius x 0.645)
};
inline constexpr std::uint32_t kSumOne = 2048;  // a voxel wholly inside
struct BrickSums {
    std::int32_t m0, m1[3];  // times kSumOne
};

// What a ball that moves straight takes from the voxels of a brick.
struct ErodeJob {
    float first[3];  // voxel (0, 0, 0) of the brick, from the ball's centre at the beginning
    float way[3];    // of the centre
    float inverse;   // 1 / radius^2
    float rate;      // exposure of a voxel that stays in the centre
    float rate_of_solid, rate_per_level;  // its factor: of solid bone at 255, and what each level below adds
    std::uint32_t key;                    // of the random numbers
};

// Blocks that a ball covers partly, each cut by a plane. Arrays of three are [axis].
struct alignas(64) CutBlocks {
    float centre[3][kCuts];  // from the ball's centre
    float edge[kCuts];
    float limit[kCuts];  // distance of the plane from the ball's centre
    float m0[kCuts];     // of the whole block
    float m1[3][kCuts];  // about its centre
    // Out, of what is covered.
    float cut_m0[kCuts];
    float cut_m1[3][kCuts];  // about the ball's centre
};

struct BrickKernels {
    const char* name;
    bool (*runs_here)();
    void (*sum)(const SumJob&, const std::uint8_t* voxels, BrickSums&);
    std::uint32_t (*erode)(const ErodeJob&, std::uint8_t* voxels);  // the levels that it took
    void (*cut)(CutBlocks&);
};

// Fastest first; the last, "generic", runs everywhere.
extern const BrickKernels kBrickKernels[];
extern const std::size_t kBrickKernelCount;
[[nodiscard]] const BrickKernels& best_brick_kernels();

void brick_sum_generic(const SumJob& job, const std::uint8_t* voxels, BrickSums& out);
std::uint32_t brick_erode_generic(const ErodeJob& job, std::uint8_t* voxels);
void brick_cut_generic(CutBlocks& blocks);
#if defined(__x86_64__)
void brick_sum_avx2(const SumJob& job, const std::uint8_t* voxels, BrickSums& out);
std::uint32_t brick_erode_avx2(const ErodeJob& job, std::uint8_t* voxels);
void brick_cut_avx2(CutBlocks& blocks);
void brick_sum_avx512(const SumJob& job, const std::uint8_t* voxels, BrickSums& out);
std::uint32_t brick_erode_avx512(const ErodeJob& job, std::uint8_t* voxels);
void brick_cut_avx512(CutBlocks& blocks);
#endif

}  // namespace tact
