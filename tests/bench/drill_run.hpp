// Moves a burr along a stroke through bone, step by step, and measures forces, times and removed voxels.
//
// Method   runs whole steps of the servo's model, force and erosion together, without a servo. The stroke runs `passes`
//          times, each time through undrilled bone; the passes are identical bit by bit. If `paced` is set, the first
//          pass runs at the rate of a loop, in a thread configured like the servo thread. best_us is the minimum time
//          of a step over all passes.
// Bone     a synthetic block or a raw volume. The block holds bone up to 78 % of its height, below a wavy surface: a
//          dense shell with air cells beneath.
// Frame    model metres, at the scale of the hand's workspace; voxel (0, 0, 0) is centred half a voxel from the corner
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
// Reads raw bytes, x fastest, without a header. Fails by StartupError if the size of the file does not match.
[[nodiscard]] BoneSample bone_of_raw_file(const std::filesystem::path& file,
                                          std::array<std::uint32_t, 3> voxels, double voxel_m);
// Height of the block's surface at (x_m, y_m).
[[nodiscard]] double block_surface_m(const BoneSample& bone, double x_m, double y_m);

// Lowers the burr to the bone in half a second, then moves it to and fro with an amplitude of 18 mm (at most a fifth of
// the block) at 0.5 Hz, with a feed of 0.3 mm/s.
[[nodiscard]] std::vector<Vec3> drill_stroke_m(const BoneSample& bone, double radius_m, std::size_t steps);

struct DrillStep {
    Vec3 force_n = Vec3::Zero();
    double us = 0.0;         // in the first pass
    double best_us = 1e300;  // minimum over all passes
    std::uint64_t removed_levels = 0;
    std::uint64_t removed_voxels = 0;  // voxels that became empty
};

[[nodiscard]] float default_fidelity();  // fidelity of the block size DrillModel::kBlockDefault

struct DrillRunSettings {
    float fidelity = default_fidelity();
    double radius_m = 3e-3;
    BurrShape shape = BurrShape::sphere;
    double length_m = 8e-3, tip_radius_m = 1e-3;  // length of a cylinder or cone head; tip of a cone
    double step_s = kDrillStepS;
    double burr_rad_s = 2.0 * 3.14159265358979323846 * 1000.0;
    int passes = 1;
    bool paced = false;  // true: the first pass is paced (loop_thread.hpp); false: all run without pauses
    bool count_voxels = false;  // slower than the steps; not included in their times
};

// Runs the stroke. Afterwards `bone` is as drilled by the last pass.
[[nodiscard]] std::vector<DrillStep> drill_along(BoneSample& bone, const std::vector<Vec3>& path_m,
                                                 const DrillRunSettings& settings);

// Of the first pass.
[[nodiscard]] Percentiles times_us(const std::vector<DrillStep>& steps);
// Of the minimum over all passes.
[[nodiscard]] Percentiles best_times_us(const std::vector<DrillStep>& steps);

}  // namespace tact::launch
