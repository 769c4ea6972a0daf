// What a drill's first contact will cost, tried before the loop starts.
#include "rt/force/drilling/drill_rehearsal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"

namespace tact::force_drill_rehearsal_test {
namespace {

constexpr double kVoxelM = 3e-4;

DrillWork summing(double blocks) {
    DrillWork work;
    work.balls = 1.0;
    work.blocks = blocks;
    return work;
}
DrillWork cutting(double blocks, double changed) {
    DrillWork work = summing(blocks);
    work.cut = 2.0 * changed;
    work.changed = changed;
    return work;
}

TEST(DrillRehearsal, finds_the_speeds_of_a_machine_among_steps_that_other_programs_held) {
    std::vector<TimedWork> steps;
    for (int i = 0; i < 400; ++i) {
        const DrillWork work = cutting(500.0 + 37.0 * (i % 31), 5.0 * (i % 17));
        const double held = i % 5 == 3 ? 1.9 : 1.0;
        steps.push_back({work, held * (0.8 * sum_cost_ns(work) + 1.7 * cut_cost_ns(work))});
    }
    const DrillSpeed speed = fit_speed(steps);
    EXPECT_NEAR(speed.sum, 0.8, 0.02);
    EXPECT_NEAR(speed.cut, 1.7, 0.05);
}

TEST(DrillRehearsal, a_tool_that_does_not_cut_tells_one_speed) {
    std::vector<TimedWork> steps;
    steps.reserve(50);
    for (int i = 0; i < 50; ++i) steps.push_back({summing(100.0 + i), 1.3 * sum_cost_ns(summing(100.0 + i))});
    const DrillSpeed speed = fit_speed(steps);
    EXPECT_NEAR(speed.sum, 1.3, 1e-6);
    EXPECT_EQ(speed.cut, speed.sum);
    EXPECT_EQ(fit_speed({}).sum, 1.0);  // nothing is known
}

TEST(DrillRehearsal, between_two_levels_the_cost_rises_by_equal_factors) {
    DrillRehearsal r;
    EXPECT_EQ(r.contact_cost(0.5F).count(), 0);  // not tried
    r.step_s = 1e-3;
    for (std::size_t i = 0; i < r.contact.size(); ++i)
        r.contact[i] = summing(1000.0 * std::exp2(static_cast<double>(i)));
    r.set_speed({});
    for (std::size_t i = 0; i < r.contact.size(); ++i)
        EXPECT_NEAR(to_s(r.contact_cost(DrillRehearsal::kLevels[i])), to_s(drill_cost(r.contact[i])), 2e-9);
    const float between = 0.5F * (DrillRehearsal::kLevels[1] + DrillRehearsal::kLevels[2]);
    EXPECT_NEAR(to_s(r.contact_cost(between)),
                std::sqrt(to_s(drill_cost(r.contact[1])) * to_s(drill_cost(r.contact[2]))), 2e-9);
    r.set_speed({2.0, 1.0});
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

}  // namespace
}  // namespace tact::force_drill_rehearsal_test
