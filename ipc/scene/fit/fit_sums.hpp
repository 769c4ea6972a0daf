// What the metrics of a fit (fit_metrics.hpp) and of its residues (residue_fit.hpp) are made of.
//
// Thread   any; no allocation
#pragma once

#include <cstdint>
#include <span>

#include "ipc/scene/density/simulated_map.hpp"

namespace tact {

// Position of an atom in voxels of the grid, (0,0,0) at the first.
[[nodiscard]] Vec3 atom_in_voxels(const DensityGrid& grid, const PlacedStructure& placed, std::size_t atom);

// Trilinear interpolation of the map at a position in voxels; outside the box the background.
[[nodiscard]] double map_at(const DensityGrid& grid, const Vec3& at_voxels, double background);

struct RegionCorrelation {
    double cc_zero = 0.0, cc_mean = 0.0;  // 0 where they are not defined
    double overlap = 0.0;                 // sum of products
    std::uint64_t voxels = 0;
};

// Of the map with `simulated`, over the voxels of the box where `region` exceeds 5 % of its largest value.
// region, simulated: one value per voxel of the box.
[[nodiscard]] RegionCorrelation correlate(const DensityGrid& grid, const VoxelBox& box,
                                          std::span<const float> region, std::span<const float> simulated);

}  // namespace tact
