// The demo scene with a workload that loads a current processor core.
//
// Surface  isosurface of the same map, resampled on a finer grid by its spline and baked by tact-prep
// Force    each atom is repeated with a fraction of its mass: the wrench stays the same, the work is multiplied. Only
//          one level of the codebook is kept, so that only the rendering detail can be reduced (see the .cpp).
// Fit      the scene has no map resolution, so that the visual process computes no correlation
#pragma once

#include <cstdint>
#include <filesystem>

namespace tact::launch {

struct SceneScale {
    int map_finer = 3;      // voxels per voxel of the demo, along each axis
    int atom_repeats = 40;  // number of copies of each atom
};

struct ExperimentScene {
    std::filesystem::path path;
    std::uint32_t vertices = 0;
    std::size_t points_summed = 0;
};

// Creates the scene in the folder. Takes seconds. Throws StartupError.
ExperimentScene make_experiment_scene(const std::filesystem::path& folder, const SceneScale& scale);

}  // namespace tact::launch
