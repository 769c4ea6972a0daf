#include "rt/start/start_drill.hpp"

#include <algorithm>

namespace tact {
namespace {

constexpr double kTubeM = 40e-3;     // that is felt, where it is thick enough
constexpr double kTubeBalls = 28.0;  // of a diameter each; DrillTool::kMax with the tip and the rounding

}  // namespace

DrillSettings burr_settings(const RtConfig& config, std::uint64_t seed) {
    const RtConfig::Drilling& d = config.drilling;
    DrillSettings s;
    for (std::size_t i = 0; i < kBurrShapeNames.size(); ++i)
        if (d.burr_shape == kBurrShapeNames[i]) s.tool.shape = static_cast<BurrShape>(i);
    s.tool.radius_m = 0.5e-3 * d.burr_diameter_mm;
    s.tool.tip_radius_m = std::min(s.tool.tip_radius_m, s.tool.radius_m);
    s.tool.length_m = 1e-3 * d.burr_length_mm;
    s.tool.shaft_radius_m = 0.5e-3 * d.shaft_diameter_mm;
    s.rate_per_s = d.rate_per_s;
    s.vibration = d.vibration;
    s.force_n_max = std::clamp(config.safety.force_n_max, 0.1, 100.0);
    s.seed = seed;
    return s;
}

DrillSettings suction_tube_settings(const RtConfig& config, std::uint64_t seed) {
    DrillSettings s = burr_settings(config, seed);
    s.tool = {};
    s.tool.cuts = false;
    s.tool.radius_m = s.tool.shaft_radius_m = 0.5e-3 * config.drilling.suction_tube_diameter_mm;
    s.tool.shaft_length_m = std::min(kTubeM, 2.0 * kTubeBalls * s.tool.radius_m);
    return s;
}

bool fit_to_voxels(DrillSettings& s, const SceneMeta& meta, const BoneBricks& bricks) {
    const double least_m = kRadiusLeast * (1.0 + 1e-9) * meta.world_per_model * bricks.voxel_m;
    if (!(s.tool.shaft_radius_m > 0.0) || s.tool.shaft_radius_m >= least_m) return false;
    if (!s.tool.cuts) s.tool.radius_m = least_m;
    if (least_m > s.tool.radius_m) return false;
    s.tool.shaft_radius_m = least_m;
    return true;
}

}  // namespace tact
