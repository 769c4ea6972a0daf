// tact reproduce drilling: the drilling paper's figures 1 to 4 on this machine, its values beside ours.
//
// Bone      solid, flat, of 0.3 mm voxels; without erosion, as there
// Figure 1  six pictures of one run of the scripted surgeon and the suction tube in the synthetic temporal bone
// Figure 2  elastic force against the penetration, R = 1 and 5 mm, smallest blocks of 0.1, 0.3 and 0.5 R and voxel by voxel;
//           and how far each is from the last
// Figure 3  time for one force, R = 1, 3 and 5 mm, against the penetration
// Figure 4  the same against R, to 20 mm, with R half in the bone
// Time      the least of some repetitions, so that other programs of the machine do not count. Voxel by voxel: one look
//           at each voxel, with eight points where it lies on the ball's surface.
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
    bool quick = false;         // fewer places
    bool pictures = true;  // figure 1, which needs the visual process and an X server to run without a screen
};

inline constexpr std::array kDrillBlocks{0.1, 0.3, 0.5};            // smallest block over R
inline constexpr std::size_t kDrillWays = kDrillBlocks.size() + 1;  // and voxel by voxel

struct DrillingRow {
    double radius_mm = 0.0, penetration_mm = 0.0;
    double true_n = 0.0;                             // sums over 512 points a voxel of the ball's surface
    std::array<double, kDrillWays> force_n{}, us{};  // the last: voxel by voxel
};

// depths: from just touching to R, or those of figure 4 at R / 2 alone.
std::vector<DrillingRow> drilling_rows(double radius_mm, int depths, int repeats, bool half_in_alone);

int reproduce_drilling(const DrillingExperiment& experiment);  // the exit code

}  // namespace tact::launch
