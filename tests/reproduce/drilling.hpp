// tact reproduce drilling: figures 1 to 4 of the drilling paper, compared with the published values.
//
// Bone      solid, flat, with voxels of 0.3 mm; without erosion, as in the paper
// Figure 1  six screenshots of a run of the scripted surgeon and the suction tube in the synthetic temporal bone
// Figure 2  elastic force over penetration for R = 1 and 5 mm, with smallest blocks of 0.1, 0.3 and 0.5 R and voxel by
//           voxel, and the errors relative to sums over 512 points per voxel
// Figure 3  time for one force over penetration for R = 1, 3 and 5 mm
// Figure 4  time for one force over R, up to 20 mm, at a penetration of R / 2
// Time      the minimum of several repetitions, which excludes the effect of other programs. Voxel by voxel: each voxel
//           is read once; a voxel on the surface of the ball is sampled at eight points.
// Writes    forces.csv, growth.csv, a PNG of each figure, drilling.json
// Thread    one; takes some seconds. Fails by StartupError.
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
    bool pictures = true;       // figure 1; requires tact-gui and an X server without a screen
};

inline constexpr std::array kDrillBlocks{0.1, 0.3, 0.5};  // smallest block / R
inline constexpr std::size_t kDrillWays =
    kDrillBlocks.size() + 1;  // number of methods; the last: voxel by voxel

struct DrillingRow {
    double radius_mm = 0.0, penetration_mm = 0.0;
    double true_n = 0.0;  // reference: sums over 512 points per voxel at the surface of the ball
    std::array<double, kDrillWays> force_n{}, us{};  // by method; the last: voxel by voxel
};

// depths: number of penetrations up to R; half_in_alone: true: all at the penetration R / 2, for figure 4.
std::vector<DrillingRow> drilling_rows(double radius_mm, int depths, int repeats, bool half_in_alone);

int reproduce_drilling(const DrillingExperiment& experiment);  // returns the exit code

}  // namespace tact::launch
