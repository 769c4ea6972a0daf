// The demo scene, made as heavy as a scene of today has to be to load a core of today.
//
// Surface  of the same map, resampled finer by its own spline and baked by tact-prep
// Force    every atom several times, with its share of the mass: the same wrench, so many times the work. One
//          level of the codebook stays, so that there is nothing but the picture to give up (see the .cpp).
// Fit      the map's resolution is left away, so that the visual process computes no correlation on the side
#pragma once

#include <cstdint>
#include <filesystem>

namespace tact::launch {

struct SceneScale {
    int map_finer = 3;      // voxels a side, for each one of the demo's
    int atom_repeats = 40;  // times that every atom is felt
};

struct ExperimentScene {
    std::filesystem::path path;
    std::uint32_t vertices = 0;
    std::size_t points_summed = 0;
};

// In that folder. Takes seconds. Throws StartupError.
ExperimentScene make_experiment_scene(const std::filesystem::path& folder, const SceneScale& scale);

}  // namespace tact::launch
