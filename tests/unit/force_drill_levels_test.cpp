// The knob of drilling while the burr cuts: what a level takes, when, at which cost and at which error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/unit/force_drilled.hpp"

namespace tact::force_drill_levels_test {
namespace {

using test::Drilled;
using test::kDrilledRadS;
using test::kDrilledVoxelM;
using test::stroke_m;

TEST(DrillLevels, a_lower_level_cuts_fewer_bricks_a_step_and_the_same_mass_a_little_later) {
    for (const double radius_m : {3e-3, 8e-3}) {
        double whole = 0.0, most_bricks = 1e9;
        for (const float level : {1.0F, 0.6F, 0.3F, 0.0F}) {
            Drilled d(radius_m);
            d.begin(stroke_m(radius_m, 0.0));
            double most = 0.0;
            for (int i = 0; i < 700; ++i) {
                (void)d.step(stroke_m(radius_m, 1e-3 * i), level);
                most = std::max(most, static_cast<double>(d.model->cut().visited));
            }
            const auto removed = static_cast<double>(d.model->removed_levels());
            if (level == 1.0F) whole = removed;
            EXPECT_GT(whole, 255.0 * 100.0);
            EXPECT_NEAR(removed, whole, 0.02 * whole) << level;
            EXPECT_LT(most, most_bricks) << level;
            most_bricks = most;
        }
    }
}

// No group has more bricks than those of a head of 48 voxels, until there are 256.
TEST(DrillLevels, groups_grow_with_the_surface_of_the_head) {
    EXPECT_EQ(ErosionTurns(20.0).groups(), 8U);
    for (const double radius : {30.0, 48.0, 49.0, 96.0, 120.0, 192.0}) {
        const std::uint32_t groups = ErosionTurns(radius).groups();
        EXPECT_GE(groups, 8.0 * radius * radius / (48.0 * 48.0)) << radius;
        EXPECT_LT(groups, std::max(16.0 * radius * radius / (48.0 * 48.0), 8.5)) << radius;
    }
    EXPECT_EQ(ErosionTurns(200.0).groups(), 256U);
    // A pass never holds more than an eighth of them, so the deadline is checked at least so often.
    for (const double radius : {100.0, 200.0}) {
        const ErosionTurns turns(radius);
        EXPECT_EQ(turns.passes_of(turns.groups()), 8U) << radius;
        EXPECT_EQ(turns.passes_of(1), 1U);
    }
}

TEST(DrillLevels, the_reported_error_bounds_what_bone_that_waits_changes_in_the_force) {
    for (const double radius_m : {2e-3, 3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.05F, 0.1F, 0.15F, 0.3F, 0.6F}) {
            Drilled full(radius_m), coarse(radius_m);
            full.begin(stroke_m(radius_m, 0.0));
            coarse.begin(stroke_m(radius_m, 0.0));
            double off = 0.0, error = 0.0, predicted = 0.0;
            int beyond = 0;
            for (int i = 0; i < 700; ++i) {
                const Vec3 p_m = stroke_m(radius_m, 1e-3 * i);
                predicted += full.model->predict(level).error;
                const StepResult a = full.step(p_m, 1.0F), b = coarse.step(p_m, level);
                const double off_n = (a.wrench_world.force_n - b.wrench_world.force_n).norm();
                beyond += off_n > a.load.error + b.load.error ? 1 : 0;
                off += off_n;
                error += b.load.error;
            }
            EXPECT_LE(beyond, 0) << radius_m << " m at " << level;
            EXPECT_GT(off, 0.0);
            EXPECT_LT(error, 60.0 * off);  // a bound, and not any bound
            EXPECT_NEAR(predicted, error, 0.5 * error) << radius_m << " m at " << level;
        }
    }
}

// Pressed in by 20 mm/s with a burr that takes bone ten times as fast: blocks are not what is wrong here.
TEST(DrillLevels, the_reported_error_bounds_it_where_bone_goes_fast) {
    for (const double radius_m : {3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.05F, 0.1F, 0.15F, 0.3F}) {
            Drilled full(radius_m, 72, 400.0), coarse(radius_m, 72, 400.0);
            const auto at = [&](int i) {
                return Vec3(1e-3 * std::sin(0.02 * i), 0.0, radius_m + 5e-4 - 2e-5 * i);
            };
            full.begin(at(0));
            coarse.begin(at(0));
            double off_n = 0.0, pushed_n = 0.0;
            for (int i = 0; i < 300; ++i) {
                const StepResult a = full.step(at(i), 1.0F), b = coarse.step(at(i), level);
                const double now_n = (a.wrench_world.force_n - b.wrench_world.force_n).norm();
                EXPECT_LE(now_n, a.load.error + b.load.error) << radius_m << " m at " << level << ", " << i;
                off_n = std::max(off_n, now_n);
                pushed_n = std::max(pushed_n, b.wrench_world.force_n.norm());
            }
            EXPECT_GT(off_n, (level > 0.0F ? 0.02 : 0.1) * pushed_n) << radius_m << " m at " << level;
        }
    }
}

// The reference is the slope of the force over the depth in flat bone.
TEST(DrillModel, the_reported_stiffness_is_the_largest_slope_of_the_force_up_to_its_limit) {
    const double radius_m = 6e-3;
    Drilled d(radius_m);
    d.model->turn_burr({0.0, 1e-3});
    d.begin({0.0, 0.0, radius_m + 1e-3});
    const auto force_n = [&](double depth_m) {
        StepResult result;
        for (int i = 0; i < 20; ++i) result = d.step({0.0, 0.0, radius_m - depth_m}, 1.0F);
        return result.wrench_world.force_n.norm();
    };
    double steepest = 0.0;
    for (int quarters = 2; quarters < 20; ++quarters) {
        const double depth_m = 0.25e-3 * quarters;
        const double low = force_n(depth_m - 0.25e-3), high = force_n(depth_m + 0.25e-3);
        if (high < DrillSettings{}.force_n_max) steepest = std::max(steepest, (high - low) / 0.5e-3);
    }
    ASSERT_GT(steepest, 100.0);
    EXPECT_GE(d.model->stiffness().force_n_m, 0.95 * steepest);
    EXPECT_LE(d.model->stiffness().force_n_m, 1.3 * steepest);
}

TEST(DrillLevels, a_deadline_that_passes_while_bone_is_cut_leaves_the_rest_for_later) {
    constexpr double kRadiusM = 16e-3;  // of 53 voxels: 16 groups in two passes at least
    Drilled on_time(kRadiusM, 120), late(kRadiusM, 120);
    on_time.begin(stroke_m(kRadiusM, 0.0));
    late.begin(stroke_m(kRadiusM, 0.0));
    int cut_short = 0;
    for (int i = 0; i < 900; ++i) {
        const Vec3 p_m = stroke_m(kRadiusM, 1e-3 * std::min(i, 600));
        (void)on_time.step(p_m, 1.0F);
        DeadlineChecks checks;
        checks.replayed = true;
        // Before the force, before the cut and before the second pass of it, of every second step.
        checks.passed_at = i % 2 == 0 && i < 800 ? 3 : 0;
        const StepResult r = late.step(p_m, 1.0F, Deadline(Instant::max(), &checks));
        if (r.status != StepStatus::out_of_time) continue;
        ++cut_short;
        EXPECT_LT(r.load.work_done, 1.0F);
        EXPECT_GT(late.model->cut().visited, 0U);  // some of it was done
    }
    EXPECT_GT(cut_short, 100);
    const auto whole = static_cast<double>(on_time.model->removed_levels());
    EXPECT_GT(whole, 255.0 * 100.0);
    EXPECT_NEAR(static_cast<double>(late.model->removed_levels()), whole, 0.02 * whole);
}

// Coarse blocks give another force, up to half of it: the hand gets there slowly, and the error says how far it still is.
TEST(DrillLevels, a_fall_of_the_level_or_a_late_step_is_no_step_of_the_force) {
    for (const bool late : {false, true}) {
        Drilled d(8e-3);
        d.model->turn_burr({0.0, 1e-3});
        const Vec3 p_m(0.7e-3, 0.3e-3, 8e-3 - 1e-3);
        d.begin(p_m);
        d.model->turn_burr({0.0, 1e-4});
        DeadlineChecks checks;
        checks.replayed = true;
        checks.passed_at = 1;
        const Deadline passed(Instant::max(), &checks);
        Vec3 before_n = d.step(p_m, 1.0F).wrench_world.force_n;
        const Vec3 first_n = before_n;
        double off_n = 0.0;
        for (int i = 0; i < 100; ++i) {
            const StepResult r =
                late ? d.step(p_m, 1.0F, i < 50 ? passed : Deadline{}) : d.step(p_m, i < 50 ? 0.0F : 1.0F);
            checks = {};
            checks.replayed = true;
            checks.passed_at = 1;
            const Vec3 now_n = r.wrench_world.force_n;
            EXPECT_LE((now_n - before_n).norm(), 0.0041) << i;
            EXPECT_LE((now_n - first_n).norm(), r.load.error) << i;
            off_n = std::max(off_n, (now_n - first_n).norm());
            before_n = now_n;
        }
        EXPECT_GT(off_n, 0.015) << late;
        EXPECT_LT((before_n - first_n).norm(), 1e-6) << late;
    }
}

// Where the ball is deep in the bone, blocks do not shrink at any level, and the floor has no error of its own.
TEST(DrillLevels, rough_blocks_add_an_error_only_where_blocks_would_shrink) {
    for (const double depth : {0.1, 0.6}) {
        Drilled d(3e-3);
        d.model->turn_burr({0.0, 1e-3});
        const Vec3 p_m(0.0, 0.0, 3e-3 * (1.0 - depth));
        d.begin(p_m);
        StepResult floor, above;
        for (int i = 0; i < 300; ++i) floor = d.step(p_m, 0.0F);
        for (int i = 0; i < 300; ++i) above = d.step(p_m, 0.2F);
        if (depth > 0.5)
            EXPECT_LT(floor.load.error, 2.0 * above.load.error);
        else
            EXPECT_GT(floor.load.error, 3.0 * above.load.error);
    }
}

// After a reset the depth is unknown. A rough level does not look at the ball twice to find it.
TEST(DrillLevels, the_first_step_at_the_floor_is_no_more_work_than_the_next) {
    Drilled d(8e-3);
    d.model->turn_burr({0.0, 1e-3});
    const Vec3 p_m(0.7e-3, 0.3e-3, 8e-3 - 1e-3);
    for (int i = 0; i < 3; ++i) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        d.model->reset(tool);
        const std::uint32_t first = d.step(p_m, 0.0F).load.items, next = d.step(p_m, 0.0F).load.items;
        EXPECT_GT(next, 0U);
        EXPECT_LE(first, next + next / 5);
    }
}

// The step plans for a slow burr; then the burr turns a hundred times as fast, and the time ends between two passes.
TEST(DrillLevels, a_late_step_that_did_more_than_it_planned_is_still_not_whole) {
    constexpr double kRadiusM = 16e-3;
    int cut_short = 0;
    for (int i = 0; i < 20; ++i) {
        Drilled d(kRadiusM, 120);
        const Vec3 p_m(0.0, 0.0, kRadiusM - 1.5e-3);
        d.begin(p_m + Vec3(0.0, 0.0, 12e-3));  // in the air: nothing is expected of the next step
        DeadlineChecks checks;
        checks.replayed = true;
        checks.passed_at = 3;
        const StepResult r = d.step(p_m + Vec3(1e-5 * i, 0.0, 0.0), 1.0F, Deadline(Instant::max(), &checks));
        if (r.status != StepStatus::out_of_time || d.model->cut().visited == 0) continue;
        ++cut_short;
        EXPECT_LT(r.load.work_done, 0.95F);
    }
    EXPECT_GT(cut_short, 10);
}

TEST(DrillLevels, the_depth_of_the_step_before_makes_no_step_and_no_oscillation) {
    Drilled d(6e-3);
    d.model->turn_burr({0.0, 1e-3});
    for (const float level : {0.0F, 0.5F, 1.0F}) {
        d.begin(Vec3(0.0, 0.0, 6.5e-3));
        Vec3 before = Vec3::Zero(), change = Vec3::Zero();
        double most_n = 0.0, jerk_n = 0.0;
        for (int i = 0; i < 1400; ++i) {  // 3.5 mm deep, by 2.5 um a step
            const Vec3 now = d.step(Vec3(0.0, 0.0, 6.5e-3 - 2.5e-6 * i), level).wrench_world.force_n;
            if (i > 0) most_n = std::max(most_n, (now - before).norm());
            if (i > 1) jerk_n = std::max(jerk_n, (now - before - change).norm());
            change = now - before;
            before = now;
        }
        EXPECT_GT(before.norm(), 2.0);
        EXPECT_LT(most_n, 0.03) << level;  // 2 N/mm of a burr of this size make 5 mN
        EXPECT_LT(jerk_n, 0.03) << level;
        Vec3 least = before, most = before;
        for (int i = 0; i < 100; ++i) {
            const Vec3 now = d.step(Vec3(0.0, 0.0, 3e-3), level).wrench_world.force_n;
            if (i > 20) least = least.cwiseMin(now);
            if (i > 20) most = most.cwiseMax(now);
            if (i == 20) least = most = now;
        }
        EXPECT_LT((most - least).norm(), 1e-9) << level;
    }
}

}  // namespace
}  // namespace tact::force_drill_levels_test
