// A mask: what a person calls structure (1), solvent or another molecule (0), and the soft edge between.
//
// Frame    as the map it belongs to, in model coordinates; its voxels may differ: it is interpolated (trilinear), and 0
//          outside its own box
// Errors   StartupError: values that are no mask (below -0.1 or above 1.1), or nothing of the map inside or outside
#pragma once

#include <string>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

// Same size, and origin and spacing equal to a hundredth of a voxel.
[[nodiscard]] bool same_grid(const DensityGrid& a, const DensityGrid& b);

// The mask at the voxels of `grid`, 0 to 1. name: of its file, for errors.
[[nodiscard]] DensityGrid mask_on(const DensityGrid& grid, const DensityGrid& mask, const std::string& name);

// value = background + mask * (value - background). mask: of the same grid.
void apply_mask(DensityGrid& grid, const DensityGrid& mask, double background);

// Share of the voxels where the mask exceeds one half.
[[nodiscard]] double share_inside(const DensityGrid& mask);

}  // namespace tact
