// The tools that tact-rt starts with.
#include <gtest/gtest.h>

#include "rt/start_drill.hpp"

namespace tact {
namespace {

TEST(StartDrill, TheConfigurationSaysWhatTheToolsAre) {
    RtConfig c;
    c.drilling.burr_diameter_mm = 4.0;
    c.drilling.burr_shape = "cone";
    c.drilling.sucker_diameter_mm = 3.0;
    const DrillSettings burr = burr_settings(c, 7), sucker = sucker_settings(c, 7);
    EXPECT_EQ(burr.tool.shape, BurrShape::cone);
    EXPECT_DOUBLE_EQ(burr.tool.radius_m, 2e-3);
    EXPECT_TRUE(burr.tool.cuts);
    EXPECT_EQ(burr.seed, 7U);
    EXPECT_EQ(sucker.tool.shape, BurrShape::sphere);
    EXPECT_FALSE(sucker.tool.cuts);
    EXPECT_DOUBLE_EQ(sucker.tool.radius_m, 1.5e-3);
    EXPECT_DOUBLE_EQ(sucker.tool.shaft_radius_m, 1.5e-3);
}

TEST(StartDrill, EverySuckerThatTheConfigurationAllowsIsATool) {
    for (double mm = 0.8; mm <= 10.0; mm += 0.1) {
        RtConfig c;
        c.drilling.sucker_diameter_mm = mm;
        const DrillTool tool = make_drill_tool(sucker_settings(c, 1).tool);
        for (std::uint32_t i = 0; i < tool.count; ++i) EXPECT_FALSE(tool.ball[i].cuts);
    }
}

TEST(StartDrill, WhatIsThinnerThanAVoxelIsFeltAsThickAsOne) {
    SceneMeta meta{};
    meta.world_per_model = 1.0;
    BoneBricks bricks;
    bricks.voxel_m = 1.25e-3;
    DrillSettings burr = burr_settings({}, 1), sucker = sucker_settings({}, 1);
    EXPECT_TRUE(fit_to_voxels(burr, meta, bricks));
    EXPECT_NEAR(burr.tool.shaft_radius_m, 1.25e-3, 1e-9);
    EXPECT_DOUBLE_EQ(burr.tool.radius_m, 3e-3);
    EXPECT_TRUE(fit_to_voxels(sucker, meta, bricks));
    EXPECT_NEAR(sucker.tool.radius_m, 1.25e-3, 1e-9);
    EXPECT_FALSE(fit_to_voxels(burr, meta, bricks));  // once
    bricks.voxel_m = 0.3e-3;
    DrillSettings fine = burr_settings({}, 1);
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
    bricks.voxel_m = 5e-3;  // larger than the head, which the model refuses
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
    fine.tool.shaft_radius_m = 0.0;  // none
    bricks.voxel_m = 1.25e-3;
    EXPECT_FALSE(fit_to_voxels(fine, meta, bricks));
}

}  // namespace
}  // namespace tact
