// A surface to look at while its level is being moved: from every stride-th voxel, as it is, without levels
// of detail. What replaces it once the level rests is a progressive mesh.
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

// Every stride-th voxel along each axis, from the first on; at least two where there are two.
[[nodiscard]] DensityGrid thinned(const DensityGrid& grid, std::uint32_t stride);
// With normals as means of the triangles about a vertex, by area.
[[nodiscard]] PlainMesh extract_contour(const DensityGrid& grid, double level, const Progress& progress = {});

// How coarse the next extraction has to be. The extraction before this one took so long and gave so many
// vertices at stride `now`; the answer keeps it below extract_s_max and vertices_max where that can be, and
// goes back to finer only where that surely fits.
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
