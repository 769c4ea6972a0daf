// Bakes a docking scene: map, structures, codebooks, isosurface, gain, and the transform from model to hand space.
//
// Fails by  StartupError; Cancelled when `progress` returns false. Writes no file: the caller writes the sections,
//           all or none.
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
    std::vector<std::string> note;  // lines "key: value": sources of map and structures
    std::optional<double> contour;  // in the map's unit; default: chosen from the histogram
    double resolution_m = 0.0;      // of the map; never guessed
    std::string resolution_source = "as given";
    std::optional<double>
        force_map_resolution_m;  // resolution of the smoothed force map; default: not smoothed
    std::uint32_t vertices_max = 1'000'000;
    std::uint32_t modes = 0;  // of each structure, for bending; at most kModesMax
    bool outside =
        false;  // structures may be beyond the reach of the hand; a body of them starts beside the map
};

struct BakedBody {
    std::string name;
    std::size_t atoms = 0;
    std::vector<std::size_t> codebook;  // number of vectors of each level
    double density_home_sigma = 0.0;    // mean over the atoms at their positions in the file
    double inside_home = 0.0;           // fraction of the atoms above the contour there
};

struct BakedDocking {
    SceneMeta meta{};
    std::string note;
    std::uint32_t vertices = 0, vertices_min = 0, triangles = 0;
    std::vector<BakedBody> bodies;
};

BakedDocking bake_docking(const DockingInput& input, SceneWriter& out, const Progress& progress = {});

// The factor among 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that brings the extent nearest to 0.16 m in
// hand space, the width that small haptic devices reach.
double world_per_model_for(double extent_m);

}  // namespace tact
