// A plain surface for display while its level is being moved: every stride-th voxel, without levels of detail. A
// progressive mesh replaces it once the level rests.
//
// Frame    model, metres.  Thread   any.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

struct PlainMesh {
    std::vector<MeshVertex> vertex;
    std::vector<std::uint32_t> index;
    [[nodiscard]] bool empty() const { return index.empty(); }
};

// Every stride-th voxel along each axis from the first; at least two if the axis has two.
[[nodiscard]] DensityGrid thinned(const DensityGrid& grid, std::uint32_t stride);
// Normals are area-weighted means of the triangles at a vertex.
[[nodiscard]] PlainMesh extract_contour(const DensityGrid& grid, double level, const Progress& progress = {});

// Stride of the next extraction. The last one, at stride `now`, took `extract_s` and gave `vertices`. The result
// keeps within extract_s_max and vertices_max where possible, and becomes finer only if that surely fits.
struct StrideLimits {
    std::size_t cells_max = 4'000'000;  // of the thinned grid
    double extract_s_max = 0.07;
    std::uint32_t vertices_max = 300'000;
};
inline constexpr std::uint32_t kStrideMax = 16;
[[nodiscard]] std::uint32_t first_stride(const DensityGrid& grid, const StrideLimits& limits);
[[nodiscard]] std::uint32_t next_stride(const DensityGrid& grid, std::uint32_t now, double extract_s,
                                        std::size_t vertices, const StrideLimits& limits);

}  // namespace tact
