// Moves a burr along a stroke through bone, step by step, for measurements: forces, times and removed voxels.
//
// Method   whole steps of the servo's model, force and erosion together, without a servo. A stroke is gone along `passes`
//          times, each time through fresh bone: the same steps, bit by bit. The first pass is timed as a loop would see
//          it, paced in a thread like the servo's where asked for; best_us is the least time of a step in all passes.
// Bone     a block made in code, or any raw volume. Bone up to 78 % of its height, under a wavy surface: a dense shell, and
//          air cells deeper.
// Frame    model metres, as large as in the hand's space; voxel (0, 0, 0) is centred on half a voxel
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/bench/percentiles.hpp"

namespace tact::launch {

inline constexpr double kDrillStepS = 1e-3;

struct BoneSample {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;  // in brick order
};

[[nodiscard]] BoneSample bone_block(std::array<std::uint32_t, 3> voxels, double voxel_m);
// Reads raw bytes, x fastest, without a header. Fails by StartupError if the file has another size.
[[nodiscard]] BoneSample bone_of_raw_file(const std::filesystem::path& file,
                                          std::array<std::uint32_t, 3> voxels, double voxel_m);
// Height of the block's surface at (x_m, y_m).
[[nodiscard]] double block_surface_m(const BoneSample& bone, double x_m, double y_m);

// Descends to the bone in half a second, then strokes 18 mm (or a fifth of the block) to both sides, half a cycle per
// second, with a feed of 0.3 mm/s.
[[nodiscard]] std::vector<Vec3> drill_stroke_m(const BoneSample& bone, double radius_m, std::size_t steps);

struct DrillStep {
    Vec3 force_n = Vec3::Zero();
    double us = 0.0;         // in the first pass
    double best_us = 1e300;  // least of all passes
    std::uint64_t removed_levels = 0;
    std::uint64_t removed_voxels = 0;  // voxels that became empty
};

[[nodiscard]] float default_fidelity();  // gives the block size DrillModel::kBlockDefault

struct DrillWay {
    float fidelity = default_fidelity();
    double radius_m = 3e-3;
    BurrShape shape = BurrShape::sphere;
    double length_m = 8e-3, tip_radius_m = 1e-3;  // length of a cylinder or cone head; tip of a cone
    double step_s = kDrillStepS;
    double burr_rad_s = 2.0 * 3.14159265358979323846 * 1000.0;
    int passes = 1;
    bool paced = false;         // the first pass: see loop_thread.hpp; else steps follow each other at once
    bool count_voxels = false;  // takes longer than the steps; not in their time
};

// bone: in the end as the last pass left it.
[[nodiscard]] std::vector<DrillStep> drill_along(BoneSample& bone, const std::vector<Vec3>& path_m,
                                                 const DrillWay& way);

[[nodiscard]] Percentiles times_us(const std::vector<DrillStep>& steps);       // of the first pass
[[nodiscard]] Percentiles best_times_us(const std::vector<DrillStep>& steps);  // of the best of all passes

}  // namespace tact::launch
