// What a drill's first contact will cost, tried before the loop starts.
#include "rt/force/drilling/drill_rehearsal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/trial_bone.hpp"

namespace tact::force_drill_rehearsal_test {
namespace {

constexpr double kVoxelM = 3e-4;

// Blocks, eighths, bricks by voxels and what erosion changes.
DrillWork some_work(double blocks, double parts = 0.0, double summed = 0.0, double changed = 0.0) {
    DrillWork work;
    work.balls = 1.0;
    work.blocks = blocks;
    work.parts = parts;
    work.summed = summed;
    work.cut = 2.0 * changed;
    work.changed = changed;
    return work;
}
TimedWork timed(const DrillWork& work, const DrillSpeed& speed) {
    return {work, 1e9 * to_s(drill_cost(work, speed))};
}

TEST(DrillSpeed, finds_the_factors_of_a_machine_among_steps_that_other_programs_held) {
    std::vector<TimedWork> steps;
    for (int i = 0; i < 400; ++i) {
        steps.push_back(
            timed(some_work(500.0 + 37.0 * (i % 31), 900.0 * (i % 7), 40.0 * (i % 5), 5.0 * (i % 17)),
                  {.walk = 0.8, .parts = 2.4, .voxels = 1.2, .cut = 1.7}));
        if (i % 5 == 3) steps.back().measured_ns *= 1.9;
    }
    const DrillSpeed speed = fit_speed(steps);
    EXPECT_NEAR(speed.walk, 0.8, 0.03);
    EXPECT_NEAR(speed.parts, 2.4, 0.05);
    EXPECT_NEAR(speed.voxels, 1.2, 0.05);
    EXPECT_NEAR(speed.cut, 1.7, 0.05);
}

TEST(DrillSpeed, kinds_of_work_that_no_step_did_have_the_factor_of_the_others) {
    std::vector<TimedWork> steps;
    steps.reserve(50);
    for (int i = 0; i < 50; ++i)
        steps.push_back(timed(some_work(100.0 + i), {.walk = 1.3, .parts = 1, .voxels = 1, .cut = 1}));
    const DrillSpeed speed = fit_speed(steps);
    for (const double factor : {speed.walk, speed.parts, speed.voxels, speed.cut})
        EXPECT_NEAR(factor, 1.3, 1e-3);
    EXPECT_EQ(fit_speed({}).walk, 1.0);  // nothing is known
}

// A machine of a tenth of the usual speed, at 2 kHz: no step of the trial ended within its period, and the speed was taken for
// the usual one.
TEST(DrillSpeed, a_machine_that_is_too_slow_for_its_rate_is_known_to_be_slow) {
    std::vector<TimedWork> steps;
    for (int i = 0; i < 100; ++i) {
        steps.push_back(timed(some_work(5000.0 + 37.0 * (i % 31), 0.0, 0.0, 20.0 * (i % 17)),
                              {.walk = 12, .parts = 12, .voxels = 12, .cut = 12}));
        EXPECT_GT(steps.back().measured_ns, 0.5e6);
    }
    EXPECT_NEAR(fit_speed(telling_steps(steps, 0.5e-3)).walk, 12.0, 1e-3);
    // Of a quick one only those within the period count: longer ones find less of their data in the caches.
    for (int i = 0; i < 30; ++i)
        steps.push_back(timed(some_work(100.0 + i, 0.0, 0.0, 2.0 * (i % 7)),
                              {.walk = 3, .parts = 3, .voxels = 3, .cut = 3}));
    EXPECT_NEAR(fit_speed(telling_steps(steps, 0.5e-3)).walk, 3.0, 1e-3);
}

TEST(DrillRehearsal, between_two_levels_the_cost_rises_by_equal_factors) {
    DrillRehearsal r;
    EXPECT_EQ(r.contact_cost(0.5F).count(), 0);  // not tried
    r.step_s = 1e-3;
    for (std::size_t i = 0; i < r.contact.size(); ++i)
        r.contact[i] = some_work(1000.0 * std::exp2(static_cast<double>(i)));
    r.set_speed({});
    for (std::size_t i = 0; i < r.contact.size(); ++i)
        EXPECT_NEAR(to_s(r.contact_cost(DrillRehearsal::kLevels[i])), to_s(drill_cost(r.contact[i])), 2e-9);
    const float between = 0.5F * (DrillRehearsal::kLevels[1] + DrillRehearsal::kLevels[2]);
    EXPECT_NEAR(to_s(r.contact_cost(between)),
                std::sqrt(to_s(drill_cost(r.contact[1])) * to_s(drill_cost(r.contact[2]))), 2e-9);
    r.set_speed({.walk = 2.0, .parts = 1.0, .voxels = 1.0, .cut = 1.0});
    EXPECT_NEAR(to_s(r.contact_cost(1.0F)), 2.0 * to_s(drill_cost(r.contact.back())), 2e-9);
}

TEST(DrillRehearsal, higher_levels_cost_more_and_a_burr_that_stands_cuts_nothing) {
    DrillSettings s;
    s.tool.radius_m = 3e-3;
    s.burr_rad_s = s.rate_at_rad_s;
    DrillRehearsal r = rehearse_drill(s, kVoxelM, 1e-3);
    EXPECT_EQ(r.step_s, 1e-3);
    r.set_speed({});
    EXPECT_GT(r.contact[0].changed, 0.0);
    EXPECT_GT(r.contact_cost(1.0F).count(), 1.3 * static_cast<double>(r.contact_cost(0.0F).count()));
    for (std::size_t i = 1; i < r.contact.size(); ++i)
        EXPECT_GT(drill_cost(r.contact[i]).count(),
                  0.8 * static_cast<double>(drill_cost(r.contact[i - 1]).count()))
            << i;
    s.burr_rad_s = 0.0;
    for (const DrillWork& work : rehearse_drill(s, kVoxelM, 1e-3).contact) {
        EXPECT_EQ(work.changed, 0.0);
        EXPECT_GT(work.blocks, 0.0);
    }
}

// The governor's rows of a continuous knob. Between 0.15 and 0.3, where rough blocks end, 0.2 cost a seventh more than foreseen.
TEST(DrillRehearsal, a_level_between_two_that_were_tried_costs_about_what_is_foreseen) {
    for (const auto& [radius_m, voxel_m] : {std::pair{20e-3, 7e-4}, {6e-3, 3e-4}}) {
        DrillSettings s;
        s.tool.radius_m = radius_m;
        s.tool.shaft_length_m = 5e-2;
        s.burr_rad_s = s.rate_at_rad_s;
        DrillRehearsal r = rehearse_drill(s, voxel_m, 1e-3);
        r.set_speed({});
        const TrialBone bone = solid_bone(radius_m, voxel_m);
        std::vector<TimedWork> unused;
        for (int row = 0; row <= 20; ++row) {
            const float level = 0.05F * static_cast<float>(row);
            const double actual_s = to_s(drill_cost(first_contact(s, bone, 1e-3, level, 10.0, unused)));
            EXPECT_GT(to_s(r.contact_cost(level)), 0.95 * actual_s) << radius_m << ' ' << level;
            EXPECT_LT(to_s(r.contact_cost(level)), 1.15 * actual_s) << radius_m << ' ' << level;
        }
    }
}

}  // namespace
}  // namespace tact::force_drill_rehearsal_test
