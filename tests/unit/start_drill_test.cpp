// The tools with which tact-rt starts.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "ipc/scene/bone/bone_volume.hpp"
#include "rt/start/start_drill.hpp"
#include "tests/support/bone_scene.hpp"

namespace tact::start_drill_test {
namespace {

TEST(StartDrill, the_configuration_defines_the_tools) {
    RtConfig c;
    c.drilling.burr_diameter_mm = 4.0;
    c.drilling.burr_shape = "cone";
    c.drilling.suction_tube_diameter_mm = 3.0;
    const DrillSettings burr = burr_settings(c, 7), suction_tube = suction_tube_settings(c, 7);
    EXPECT_EQ(burr.tool.shape, BurrShape::cone);
    EXPECT_DOUBLE_EQ(burr.tool.radius_m, 2e-3);
    EXPECT_TRUE(burr.tool.cuts);
    EXPECT_EQ(burr.seed, 7U);
    EXPECT_EQ(suction_tube.tool.shape, BurrShape::sphere);
    EXPECT_FALSE(suction_tube.tool.cuts);
    EXPECT_DOUBLE_EQ(suction_tube.tool.radius_m, 1.5e-3);
    EXPECT_DOUBLE_EQ(suction_tube.tool.shaft_radius_m, 1.5e-3);
    EXPECT_NEAR(burr.burr_rad_s, 6283.2, 0.1);
    EXPECT_EQ(suction_tube.burr_rad_s, 0.0);
}

TEST(StartDrill, the_configuration_defines_the_switches_of_the_tools) {
    RtConfig c;
    EXPECT_EQ(drill_switch(c, 0).by, DriveSwitch::button);
    c.drilling.pedal = "line";
    c.drilling.suction = "always";
    EXPECT_EQ(drill_switch(c, 0).by, DriveSwitch::line);
    EXPECT_EQ(drill_switch(c, 0).line, kLineBurr);
    EXPECT_EQ(drill_switch(c, 1).by, DriveSwitch::always);
    EXPECT_EQ(drill_switch(c, 1).line, kLineSuction);
    c.drilling.irrigation_ml_min = 60.0;
    EXPECT_DOUBLE_EQ(drill_rates(c).irrigation_m3_s, 1e-6);
}

TEST(StartDrill, every_allowed_suction_tube_diameter_makes_a_tool) {
    for (int tenths_mm = 8; tenths_mm <= 100; ++tenths_mm) {
        RtConfig c;
        c.drilling.suction_tube_diameter_mm = 0.1 * tenths_mm;
        const DrillTool tool = make_drill_tool(suction_tube_settings(c, 1).tool);
        for (std::uint32_t i = 0; i < tool.count; ++i) EXPECT_FALSE(tool.ball[i].cuts);
    }
}

TEST(StartDrill, burrs_up_to_the_largest_allowed_diameter_make_a_tool) {
    for (int halves_mm = 8; halves_mm <= 80; ++halves_mm) {
        const double mm = 0.5 * halves_mm;
        RtConfig c;
        c.drilling.burr_diameter_mm = mm;
        c.drilling.shaft_diameter_mm = std::min(c.drilling.shaft_diameter_mm, mm);
        EXPECT_GT(make_drill_tool(burr_settings(c, 1).tool).count, 1U) << mm;
    }
}

TEST(StartDrill, a_tool_thinner_than_a_voxel_is_thickened_to_a_voxel) {
    SceneMeta meta{};
    meta.world_per_model = 1.0;
    BoneBricks bricks;
    bricks.voxel_m = 1.25e-3;
    DrillSettings burr = burr_settings({}, 1), suction_tube = suction_tube_settings({}, 1);
    EXPECT_TRUE(fit_to_voxels(burr, meta, bricks));
    EXPECT_NEAR(burr.tool.shaft_radius_m, 1.25e-3, 1e-9);
    EXPECT_DOUBLE_EQ(burr.tool.radius_m, 3e-3);
    EXPECT_TRUE(fit_to_voxels(suction_tube, meta, bricks));
    EXPECT_NEAR(suction_tube.tool.radius_m, 1.25e-3, 1e-9);
    EXPECT_FALSE(fit_to_voxels(burr, meta, bricks));  // changed only once
    bricks.voxel_m = 0.3e-3;
    DrillSettings fine = burr_settings({}, 1);
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
    bricks.voxel_m = 5e-3;  // larger than the head; the model refuses that
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
    fine.tool.shaft_radius_m = 0.0;  // no shaft
    bricks.voxel_m = 1.25e-3;
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
}

// A level is chosen before the first touch: what one costs is known then, of both tools.
TEST(StartDrill, the_tools_are_tried_before_the_loop_starts) {
    BoneBricks bricks;
    bricks.size = {24, 24, 24};
    bricks.voxel_m = 3e-4;
    const std::vector<std::uint8_t> density(bricks.bytes(), 255);
    const SceneWriter out = bone_scene(bricks, density);
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "a block");
    const auto region = std::make_unique<RtRegion>();
    const RtConfig config;
    DrillScene shared(scene, config, *region);
    for (const std::uint32_t hand : {0U, 1U})
        EXPECT_GT(load_drill(scene, config, 1, shared, hand)->predict(0.5F).cost_foreseen.count(), 0) << hand;
}

}  // namespace
}  // namespace tact::start_drill_test
