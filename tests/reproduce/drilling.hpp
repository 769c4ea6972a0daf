// tact reproduce drilling: figures 1 to 4 of the drilling paper on this machine, beside the published values.
//
// Bone      solid, flat, of 0.3 mm voxels; without erosion, as in the paper
// Figure 1  six screenshots of a run of the scripted surgeon and the suction tube in the synthetic temporal bone
// Figure 2  elastic force against the penetration, R = 1 and 5 mm, smallest blocks of 0.1, 0.3 and 0.5 R and voxel by
//           voxel, and their errors against 512 points per voxel
// Figure 3  time for one force, R = 1, 3 and 5 mm, against the penetration
// Figure 4  time for one force against R, up to 20 mm, with the penetration R / 2
// Time      the minimum of several repetitions, which excludes other programs. Voxel by voxel: one read of each voxel,
//           with eight points if it lies on the ball's surface.
// Writes    forces.csv, growth.csv, PNG of each figure, drilling.json
// Thread    one; some seconds. Fails by StartupError.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

struct DrillingExperiment {
    std::filesystem::path out;  // folder
    bool quick = false;         // fewer positions
    bool pictures = true;       // figure 1; needs the visual process, and an X server without a screen
};

inline constexpr std::array kDrillBlocks{0.1, 0.3, 0.5};            // smallest block over R
inline constexpr std::size_t kDrillWays = kDrillBlocks.size() + 1;  // the last: voxel by voxel

struct DrillingRow {
    double radius_mm = 0.0, penetration_mm = 0.0;
    double true_n = 0.0;                             // sums over 512 points per voxel of the ball's surface
    std::array<double, kDrillWays> force_n{}, us{};  // the last: voxel by voxel
};

// depths: number of penetrations up to R; half_in_alone: one penetration of R / 2, for figure 4.
std::vector<DrillingRow> drilling_rows(double radius_mm, int depths, int repeats, bool half_in_alone);

int reproduce_drilling(const DrillingExperiment& experiment);  // returns the exit code

}  // namespace tact::launch
