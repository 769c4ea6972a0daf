// Puts a docking scene together: map, structures, codebooks, isosurface, gain and how the hand's world maps
// onto it.
//
// Fails by  StartupError; Cancelled when `progress` returns false. Nothing is written here: the caller writes
//           the sections, whole or not at all.
// Repeats   the same input gives the same sections.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

struct DockingInput {
    std::string title;
    DensityGrid grid;
    std::vector<Structure> structures;
    std::vector<std::string> note;       // lines "key: value": where map and structures came from
    std::optional<double> contour;       // in the map's unit; chosen where absent
    std::optional<double> resolution_m;  // taken as four voxels where absent
    std::optional<double>
        force_map_resolution_m;  // the hand feels the map smoothed to this; as it is where absent
    std::uint32_t vertices_max = 1'000'000;
};

struct BakedBody {
    std::string name;
    std::size_t atoms = 0;
    std::vector<std::size_t> codebook;  // vectors of each level
    double density_home_sigma = 0.0;    // mean over the atoms in the place that the file has them
    double inside_home = 0.0;           // share of the atoms above the contour there
};

struct BakedDocking {
    SceneMeta meta{};
    std::string note;
    std::uint32_t vertices = 0, vertices_min = 0, triangles = 0;
    std::vector<BakedBody> bodies;
};

BakedDocking bake_docking(const DockingInput& input, SceneWriter& out, const Progress& progress = {});

// The one of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that brings the extent nearest to 0.16 m of
// the hand's space, the width that small haptic devices reach.
double world_per_model_for(double extent_m);

}  // namespace tact
