// The demo scene, with a workload that is heavy enough for a current processor core.
//
// Surface  of the same map, resampled on a finer grid by its spline and baked by tact-prep
// Force    every atom several times, with a fraction of its mass: the same wrench, at a multiple of the work. One level of
//          the codebook stays, so that only the rendering detail can be reduced (see the .cpp).
// Fit      without the map's resolution, so that the visual process computes no correlation
#pragma once

#include <cstdint>
#include <filesystem>

namespace tact::launch {

struct SceneScale {
    int map_finer = 3;      // voxels per side for each one of the demo's
    int atom_repeats = 40;  // number of copies of every atom
};

struct ExperimentScene {
    std::filesystem::path path;
    std::uint32_t vertices = 0;
    std::size_t points_summed = 0;
};

// Creates the scene in the folder. Takes seconds. Throws StartupError.
ExperimentScene make_experiment_scene(const std::filesystem::path& folder, const SceneScale& scale);

}  // namespace tact::launch
