#include "rt/start/start_drill.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <numbers>

#include "hal/api/lines.hpp"

namespace tact {
namespace {

constexpr double kShaftBeyondHeadM = 10e-3;
constexpr double kTubeM = 40e-3;     // length of the tube in the force model, if it is thick enough
constexpr double kTubeBalls = 28.0;  // longest tube in diameters; DrillTool::kMax minus tip and rounding

DriveSwitch switch_named(const std::string& name) {
    return name == "line" ? DriveSwitch::line : name == "always" ? DriveSwitch::always : DriveSwitch::button;
}

double burr_rad_s(const RtConfig& config) { return config.drilling.burr_rpm * 2.0 * std::numbers::pi / 60.0; }

}  // namespace

DrillScene::DrillScene(const SceneFile& scene, const RtConfig& config, RtRegion& region)
    : bone_(scene), publisher_(region.drill, region.touch, drill_rates(config)) {}

DrillRates drill_rates(const RtConfig& config) {
    const RtConfig::Drilling& d = config.drilling;
    return {.irrigation_m3_s = d.irrigation_ml_min * 1e-6 / 60.0,
            .irrigation_always = d.irrigation == "always",
            .suction_m3_s = d.suction_l_min * 1e-3 / 60.0};
}

DriveInput drill_switch(const RtConfig& config, std::uint32_t hand) {
    if (hand == 0) return {switch_named(config.drilling.pedal), kLineBurr};
    return {switch_named(config.drilling.suction), kLineSuction};
}

DrillSettings burr_settings(const RtConfig& config, std::uint64_t seed) {
    const RtConfig::Drilling& d = config.drilling;
    DrillSettings s;
    for (std::size_t i = 0; i < kBurrShapeNames.size(); ++i)
        if (d.burr_shape == kBurrShapeNames[i]) s.tool.shape = static_cast<BurrShape>(i);
    s.tool.radius_m = 0.5e-3 * d.burr_diameter_mm;
    s.tool.tip_radius_m = std::min(s.tool.tip_radius_m, s.tool.radius_m);
    s.tool.length_m = 1e-3 * d.burr_length_mm;
    s.tool.shaft_radius_m = 0.5e-3 * d.shaft_diameter_mm;
    // A large head has a longer shaft, so that every diameter that the configuration allows is a tool.
    s.tool.shaft_length_m =
        std::max(s.tool.shaft_length_m, s.tool.radius_m + s.tool.length_m + kShaftBeyondHeadM);
    s.burr_rad_s = burr_rad_s(config);
    s.rate_per_s = d.rate_per_s;
    s.diamond_share = d.diamond_share;
    s.grit = d.burr_grit == kBurrGritNames[1] ? BurrGrit::diamond : BurrGrit::cutting;
    s.vibration = d.vibration;
    s.force_n_max = std::clamp(config.safety.force_n_max, 0.1, 100.0);
    s.seed = seed;
    return s;
}

DrillSettings suction_tube_settings(const RtConfig& config, std::uint64_t seed) {
    DrillSettings s = burr_settings(config, seed);
    s.tool = {};
    s.burr_rad_s = 0.0;
    s.tool.cuts = false;
    s.tool.radius_m = s.tool.shaft_radius_m = 0.5e-3 * config.drilling.suction_tube_diameter_mm;
    s.tool.shaft_length_m = std::min(kTubeM, 2.0 * kTubeBalls * s.tool.radius_m);
    return s;
}

std::unique_ptr<DrillModel> load_drill(const SceneFile& scene, const RtConfig& config, std::uint64_t seed,
                                       DrillScene& shared, std::uint32_t hand) {
    const SceneMeta meta = read_meta(scene);
    DrillSettings settings = hand == 0 ? burr_settings(config, seed) : suction_tube_settings(config, seed);
    if (fit_to_voxels(settings, meta, shared.bone().octree.bricks()))
        spdlog::warn("the {} is thinner than the voxels allow; the force model uses a diameter of {:.2f} mm",
                     settings.tool.cuts ? "shaft" : "suction tube", 2e3 * settings.tool.shaft_radius_m);
    auto model = std::make_unique<DrillModel>(meta, shared.bone(), settings);
    const BoneBricks& bricks = shared.bone().octree.bricks();
    model->foresee(rehearse_drill(settings, bricks, shared.bone().octree.density(),
                                  meta.world_per_model * bricks.voxel_m, expected_period_s(config)));
    model->publish_to(shared.publisher());
    return model;
}

}  // namespace tact
