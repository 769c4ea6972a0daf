// The knob of drilling while the burr cuts: what a level takes, when, at which cost and at which error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::force_drill_levels_test {
namespace {

constexpr double kVoxelM = 3e-4, kFullRadS = 6283.0;

// Bone below z = 0 of the world, under a tool without a shaft.
struct Drilled {
    BoneBlock bone;
    SceneMeta meta{};
    std::unique_ptr<DrillBone> shared;
    std::unique_ptr<DrillModel> model;

    explicit Drilled(double radius_m, std::uint32_t edge = 72, double rate_per_s = DrillSettings{}.rate_per_s)
        : bone(
              edge, kVoxelM, [=](const Vec3& p) { return p.z() < 0.5 * edge - 0.5 ? 1.0 : 0.0; }, 1) {
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        bone.bricks.origin_m = -kVoxelM * Vec3::Constant(0.5 * edge - 0.5);
        shared = std::make_unique<DrillBone>(bone.bricks, bone.density, bone.revision);
        DrillSettings s;
        s.burr_rad_s = kFullRadS;
        s.tool.radius_m = radius_m;
        s.tool.shaft_radius_m = 0.0;
        s.rate_per_s = rate_per_s;
        model = std::make_unique<DrillModel>(meta, *shared, s);
        model->turn_burr({kFullRadS, 1e-3});
    }
    StepResult step(const Vec3& p_m, float fidelity, const Deadline& deadline = {}) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        Budget budget;
        budget.fidelity = fidelity;
        budget.deadline = deadline;
        return model->step(tool, budget);
    }
    void begin(const Vec3& p_m) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        model->reset(tool);
        for (int i = 0; i < 400; ++i) (void)step(p_m, 1.0F);
    }
};

// To and fro by 4 mm, sinking to 1.5 mm in 0.3 s and then by 2 mm/s; above the bone at first.
Vec3 stroke_m(double radius_m, double t_s) {
    const double depth_m = t_s < 0.3 ? -1e-3 + t_s / 0.3 * 2.5e-3 : 1.5e-3 + 2e-3 * (t_s - 0.3);
    return {4e-3 * std::sin(12.0 * t_s), 1e-3 * std::sin(7.0 * t_s), radius_m - depth_m};
}

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

TEST(DrillLevels, predicted_work_is_that_of_the_step) {
    for (const double radius_m : {2e-3, 3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.3F, 0.6F, 1.0F}) {
            Drilled d(radius_m);
            d.begin(stroke_m(radius_m, 0.0));
            double expected = 0.0, found = 0.0;
            for (int i = 0; i < 700; ++i) {
                if (i > 300) expected += d.model->predict(level).items;
                const StepResult r = d.step(stroke_m(radius_m, 1e-3 * i), level);
                if (i > 300) found += r.load.items;
            }
            EXPECT_NEAR(expected, found, 0.1 * found) << radius_m << " m at " << level;
        }
    }
}

// The stiffness is measured in one direction a step, a ball pressed deeper meets more bone, and blocks halve: a step that is compared
// with the one before would look like an interrupted one.
TEST(DrillLevels, a_whole_step_is_compared_with_the_work_that_it_did) {
    constexpr double kRadiusM = 20e-3;
    Drilled d(kRadiusM, 160);
    const Vec3 pressed_m = stroke_m(kRadiusM, 0.3);
    d.begin(pressed_m);
    d.model->turn_burr({0.0, 1e-3});
    for (int i = 0; i < 80; ++i) (void)d.step(pressed_m, 0.5F);
    std::vector<double> predicted, items;
    for (int i = 0; i < 16; ++i) {
        const StepResult r = d.step(pressed_m, 0.5F);
        predicted.push_back(to_us(r.load.cost_predicted));
        items.push_back(r.load.items);
    }
    const auto [least, most] = std::minmax_element(items.begin(), items.end());
    ASSERT_GT(*most, 1.1 * *least);
    const auto about_mean = [](std::vector<double> v) {
        const double mean = std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
        for (double& x : v) x -= mean;
        return v;
    };
    const std::vector<double> a = about_mean(predicted), b = about_mean(items);
    const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
        return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
    };
    EXPECT_GT(dot(a, b), 0.9 * std::sqrt(dot(a, a) * dot(b, b)));
}

// What another level would do, told from this one.
TEST(DrillLevels, work_predicted_from_another_level_is_right_within_a_factor_of_two) {
    for (const double radius_m : {2e-3, 3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.3F, 0.6F, 1.0F}) {
            Drilled at_half(radius_m), d(radius_m);
            at_half.begin(stroke_m(radius_m, 0.0));
            d.begin(stroke_m(radius_m, 0.0));
            double expected = 0.0, found = 0.0;
            for (int i = 0; i < 700; ++i) {
                const Vec3 p_m = stroke_m(radius_m, 1e-3 * i);
                if (i > 300) expected += to_us(at_half.model->predict(level).cost_predicted);
                if (i > 300) found += to_us(d.model->predict(level).cost_predicted);
                (void)at_half.step(p_m, 0.5F);
                (void)d.step(p_m, level);
            }
            EXPECT_LT(expected, 2.0 * found) << radius_m << " m at " << level;
            EXPECT_GT(expected, 0.5 * found) << radius_m << " m at " << level;
        }
    }
}

// Which blocks are looked at in halves is no smooth function of the level: the bone in the burr's surface decides.
TEST(DrillLevels, work_in_a_pocket_is_expected_from_another_level_within_a_third) {
    constexpr double kRadiusM = 20e-3;
    const std::vector<float> levels{0.15F, 0.3F, 0.5F, 0.7F};
    std::vector<std::unique_ptr<Drilled>> at;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        at.push_back(std::make_unique<Drilled>(kRadiusM, 160));
        at.back()->begin(stroke_m(kRadiusM, 0.0));
    }
    std::vector<std::vector<double>> us(levels.size(), std::vector<double>(levels.size(), 0.0));
    for (int i = 0; i < 900; ++i) {
        const Vec3 p_m = stroke_m(kRadiusM, 0.5e-3 * i);
        for (std::size_t from = 0; from < levels.size(); ++from) {
            for (std::size_t to = 0; to < levels.size() && i > 500; ++to)
                us[from][to] += to_us(at[from]->model->predict(levels[to]).cost_predicted);
            (void)at[from]->step(p_m, levels[from]);
        }
    }
    for (std::size_t from = 0; from < levels.size(); ++from) {
        for (std::size_t to = 0; to < levels.size(); ++to) {
            EXPECT_LT(us[from][to], 1.33 * us[to][to]) << levels[from] << " to " << levels[to];
            EXPECT_GT(us[from][to], us[to][to] / 1.33) << levels[from] << " to " << levels[to];
        }
    }
}

// The level of a hand in free space must fit when it touches, and later in the pocket that it cuts: it may not be chosen by
// the cost of free space.
TEST(DrillLevels, in_free_space_a_level_is_predicted_to_cost_what_a_pocket_costs) {
    constexpr int kSteps = 4000, kGrown = 2000;
    for (const double radius_m : {8e-3, 20e-3}) {
        Drilled d(radius_m, radius_m > 0.01 ? 160 : 72);
        DrillRehearsal rehearsal = rehearse_drill(d.model->settings(), kVoxelM, 1e-3);
        rehearsal.speed = {};  // work, not the time of this machine
        d.model->foresee(rehearsal);
        double z_m = radius_m + 1e-3;
        d.begin({0.0, 0.0, z_m});
        const double free_us = to_us(d.model->predict(0.25F).cost_foreseen);
        double pocket_us = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double t_s = 1e-3 * i;
            const StepResult r = d.step({6e-3 * std::sin(8.0 * t_s), 2e-3 * std::sin(3.0 * t_s), z_m}, 0.25F);
            z_m -= std::clamp((3.0 - d.model->elastic_n()) * 2e-5, -2e-5, 1e-5);  // pressed with 3 N
            if (i > kGrown) pocket_us = std::max(pocket_us, to_us(r.load.cost_predicted));
        }
        EXPECT_GT(free_us, 0.6 * pocket_us) << radius_m;
        EXPECT_LT(free_us, 1.7 * pocket_us) << radius_m;
        // The contact has shown what it costs; after a while in free space that is forgotten.
        EXPECT_EQ(d.model->predict(0.25F).cost_foreseen.count(), 0);
        for (int i = 0; i < 9000; ++i) (void)d.step({0.0, 0.0, 3.0 * radius_m}, 0.0F);
        EXPECT_EQ(d.model->predict(0.25F).cost_foreseen.count(), 0);
        for (int i = 0; i < 1500; ++i) (void)d.step({0.0, 0.0, 3.0 * radius_m}, 0.0F);
        EXPECT_EQ(to_us(d.model->predict(0.25F).cost_foreseen), free_us);
    }
}

// Only a step that another program held cuts more groups: the next ones do not.
TEST(DrillLevels, a_held_step_raises_no_prediction_of_cost_or_error) {
    constexpr double kRadiusM = 20e-3;
    Drilled d(kRadiusM, 160);
    d.begin(stroke_m(kRadiusM, 0.0));
    for (int i = 0; i < 500; ++i) (void)d.step(stroke_m(kRadiusM, 1e-3 * i), 0.0F);
    const PathLoad before = d.model->predict(0.0F);
    d.model->turn_burr({kFullRadS, 45e-3});
    (void)d.step(stroke_m(kRadiusM, 0.5), 0.0F);
    const PathLoad after = d.model->predict(0.0F);
    EXPECT_LT(to_us(after.cost_predicted), 1.3 * to_us(before.cost_predicted));
    EXPECT_LT(after.error, 1.3F * before.error);
    // A rate that stays lower is followed.
    for (int i = 0; i < 300; ++i) {
        d.model->turn_burr({kFullRadS, 45e-3});
        (void)d.step(stroke_m(kRadiusM, 0.5), 0.0F);
    }
    EXPECT_GT(to_us(d.model->predict(0.0F).cost_predicted), 1.3 * to_us(before.cost_predicted));
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

// A burr that starts cuts one group a step: what the others will cost is expected from the first.
TEST(DrillLevels, the_first_group_tells_what_all_will_cost) {
    Drilled d(8e-3);
    Vec3 place = stroke_m(8e-3, 0.3);
    ToolState tool;
    tool.T_world_tool.p_m = place;
    d.model->reset(tool);
    double first = 0.0, all = 0.0;
    for (int i = 0; i < 20; ++i) {
        (void)d.step(place, 1.0F);
        if (i == 1) first = d.model->predict(1.0F).items;
        all = d.model->predict(1.0F).items;
    }
    EXPECT_NEAR(first, all, 0.3 * all);
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
