// The governor: the published law, the order in which paths are lowered, and invariants for any input.
#include "rt/govern/governor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/govern_fixture.hpp"

namespace tact::govern_governor_test {
namespace {

using std::chrono::milliseconds;

using namespace govern_test;

TEST(SensitusLaw, equals_the_published_equation) {
    // V <- V - s V (r_g - r_c) / r_g
    EXPECT_DOUBLE_EQ(sensitus_factor(600.0, 1000.0, 0.5, 0.05), 1.0 - 0.5 * (1000.0 - 600.0) / 1000.0);
    // V <- V + s V (r_c - r_g) / r_g
    EXPECT_DOUBLE_EQ(sensitus_factor(1500.0, 1000.0, 0.5, 0.05), 1.0 + 0.5 * (1500.0 - 1000.0) / 1000.0);
    // No change within the tolerance, edges included.
    EXPECT_DOUBLE_EQ(sensitus_factor(950.0, 1000.0, 0.5, 0.05), 1.0);
    EXPECT_DOUBLE_EQ(sensitus_factor(1050.0, 1000.0, 0.5, 0.05), 1.0);
}

TEST(Governor, lowers_the_display_first_and_the_force_last) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1000.0}, {kMesh, kForce});
    int steps = 0;
    while (governor.level(0) > kMesh.floor && steps++ < 1000) {
        static_cast<void>(governor.step(500.0, kStep));
        ASSERT_FLOAT_EQ(governor.level(1), 1.0F);
    }
    EXPECT_FLOAT_EQ(governor.level(0), kMesh.floor);
    static_cast<void>(governor.step(500.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(1), 0.75F);
    for (int i = 0; i < 100; ++i) static_cast<void>(governor.step(500.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(1), kForce.floor);
    EXPECT_EQ(governor.paths()[1].reason, LevelReason::at_floor);
}

// A display whose model is off by a multiple would swing between two levels for ever.
TEST(Governor, steps_to_and_fro_of_the_default_law_become_small) {
    constexpr KnobSpec kMiddle{.path = "gui.mesh", .floor = 0.01F, .start = 0.3F};
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMiddle});
    std::array<double, 8> change{};
    for (std::size_t turn = 0; turn < change.size(); ++turn) {
        const float before = governor.level(0);
        for (int i = 0; i < 100 && governor.level(0) == before; ++i)
            static_cast<void>(governor.step(turn % 2 == 0 ? 960.0 : 1040.0, kStep));
        ASSERT_NE(governor.level(0), before) << turn;
        change[turn] = std::abs(std::log(static_cast<double>(governor.level(0) / before)));
    }
    EXPECT_LT(change[6], 0.3 * change[0]);
    EXPECT_LT(change[7], 0.3 * change[1]);
}

TEST(Governor, a_knob_with_floor_zero_stays_high_enough_to_recover_within_sixty_steps) {
    constexpr KnobSpec kNoFloor{.path = "force", .floor = 0.0F, .start = 1.0F, .haptic = true};
    for (const Law law : {Law::sensitus, Law::elastic}) {
        Governor governor = with({.law = law, .goal_hz = 1000.0}, {kNoFloor});
        for (int i = 0; i < 1000; ++i) static_cast<void>(governor.step(10.0, kStep));
        EXPECT_NEAR(governor.level(0), 1e-3, 1e-6);
        EXPECT_EQ(governor.paths()[0].reason, LevelReason::at_floor);
        int steps = 0;
        while (governor.level(0) < 1.0F && steps < 1000) {
            static_cast<void>(governor.step(5000.0, kStep));
            ++steps;
        }
        EXPECT_LT(steps, 60);
    }
}

TEST(Governor, restores_the_force_before_the_display_and_no_faster_than_its_slew) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1000.0}, {kMesh, kForce});
    for (int i = 0; i < 200; ++i) static_cast<void>(governor.step(100.0, kStep));
    float before = governor.level(1);
    while (governor.level(1) < 1.0F) {
        ASSERT_TRUE(governor.step(5000.0, kStep));
        ASSERT_FLOAT_EQ(governor.level(0), kMesh.floor);
        ASSERT_LE(governor.level(1) - before, 0.2F + 1e-6F);
        before = governor.level(1);
    }
    ASSERT_TRUE(governor.step(5000.0, kStep));
    EXPECT_GT(governor.level(0), kMesh.floor);
}

TEST(Governor, an_absent_display_keeps_its_level_and_the_force_falls_instead) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1000.0}, {kMesh, kForce});
    governor.set_present(0, false);
    static_cast<void>(governor.step(500.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), 1.0F);
    EXPECT_FLOAT_EQ(governor.level(1), 0.75F);
}

// Set-up of the docking paper: force loop and display share a processor.
// rate = capacity / (force + display * V). The equilibrium is known in closed form.
TEST(Governor, converges_on_a_shared_processor_to_the_level_where_the_rate_is_the_goal) {
    for (const double gain : {0.1, 0.5, 1.0}) {
        Governor governor =
            with({.law = Law::sensitus, .goal_hz = 800.0, .gain = gain, .tolerance = 0.02}, {kMesh});
        const auto rate_hz = [](double level) {
            return 1.0 / (0.8e-3 + 1.02e-3 * level);
        };  // 550 Hz unadapted
        EXPECT_NEAR(rate_hz(1.0), 550.0, 1.0);
        for (int i = 0; i < 200; ++i)
            static_cast<void>(governor.step(rate_hz(static_cast<double>(governor.level(0))), kStep));
        const double rest = (1.0 / 800.0 - 0.8e-3) / 1.02e-3;
        EXPECT_NEAR(rate_hz(static_cast<double>(governor.level(0))), 800.0, 0.02 * 800.0) << gain;
        EXPECT_NEAR(static_cast<double>(governor.level(0)), rest, 0.06) << gain;
        EXPECT_EQ(governor.paths()[0].reason, LevelReason::hold);
    }
}

TEST(Governor, an_unreachable_goal_ends_at_the_floor_and_a_reachable_one_recovers_at_once) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1400.0}, {kMesh});
    const auto rate_hz = [](double level) { return 1.0 / (0.8e-3 + 1.02e-3 * level); };
    for (int i = 0; i < 500; ++i)
        static_cast<void>(governor.step(rate_hz(static_cast<double>(governor.level(0))), kStep));
    EXPECT_FLOAT_EQ(governor.level(0), kMesh.floor);
    EXPECT_FALSE(governor.step(rate_hz(0.05), kStep));  // clamped: no wind-up
    ASSERT_TRUE(governor.set_goal_hz(800.0));
    EXPECT_TRUE(governor.step(rate_hz(0.05), kStep));
    EXPECT_GT(governor.level(0), kMesh.floor);
}

TEST(Governor, any_rates_leave_every_level_between_floor_and_one) {
    const bool held = rc::check([] {
        const double gain = *rc::gen::inRange(1, 1001) * 1e-3;
        const double tolerance = *rc::gen::inRange(0, 501) * 1e-3;
        KnobSpec zero{.path = "z", .floor = 0.0F, .start = 0.5F};
        Governor governor =
            with({.law = Law::sensitus, .goal_hz = 1000.0, .gain = gain, .tolerance = tolerance},
                 {kMesh, kForce, zero});
        for (int i = 0; i < 100; ++i) {
            const double nasty = *rc::gen::element(std::numeric_limits<double>::quiet_NaN(), -1.0, 1e308, 0.0,
                                                   std::numeric_limits<double>::infinity());
            const double rate = *rc::gen::weightedElement<bool>({{9, true}, {1, false}})
                                    ? *rc::gen::inRange(0, 100000) * 0.1
                                    : nasty;
            float before[3];
            for (std::size_t p = 0; p < 3; ++p) before[p] = governor.level(p);
            static_cast<void>(governor.step(rate, kStep));
            for (std::size_t p = 0; p < 3; ++p) {
                const float level = governor.level(p);
                RC_ASSERT(level >= governor.paths()[p].knob.floor && level <= 1.0F);
                if (rate >= 0.0 && rate < 1000.0 * (1.0 - tolerance)) RC_ASSERT(level <= before[p]);
                if (rate > 1000.0 * (1.0 + tolerance) && std::isfinite(rate)) RC_ASSERT(level >= before[p]);
            }
        }
    });
    EXPECT_TRUE(held);
}

// The same for the law "elastic", for any frame costs.
TEST(Governor, any_rates_and_frame_costs_leave_every_level_of_the_elastic_law_between_floor_and_one) {
    const bool held = rc::check([] {
        KnobSpec zero{.path = "z", .floor = 0.0F, .start = 0.5F};
        Governor governor =
            with({.law = Law::elastic, .goal_hz = 1000.0, .display_goal_hz = 30.0}, {kMesh, kForce, zero});
        const auto number = [](int to) {
            const double nasty = *rc::gen::element(std::numeric_limits<double>::quiet_NaN(), -1.0, 1e308, 0.0,
                                                   std::numeric_limits<double>::infinity());
            return *rc::gen::weightedElement<bool>({{9, true}, {1, false}}) ? *rc::gen::inRange(0, to) * 1e-3
                                                                            : nasty;
        };
        for (int i = 0; i < 100; ++i) {
            const auto before = governor.paths();
            const float force = before[1].level;
            if (*rc::gen::inRange(0, 2) == 0) {
                static_cast<void>(governor.step(1e3 * number(5000), kStep));
            } else {
                static_cast<void>(governor.update({number(3000), number(3000), number(3000)}));
                RC_ASSERT(governor.level(1) == force);  // the display goal never lowers the force
            }
            for (const GovernedPath& p : governor.paths())
                RC_ASSERT(p.level >= p.knob.floor && p.level <= 1.0F);
        }
    });
    EXPECT_TRUE(held);
}

TEST(Governor, the_elastic_law_answers_a_large_error_by_its_model_and_a_small_one_calmly) {
    const auto level_at = [](double rate_hz) {
        Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh});
        // Half of the display's cost varies (the prior), and the display uses half of the core.
        for (int i = 0; i < 50; ++i)
            static_cast<void>(governor.update({.work_s = 0.02, .processor_s = 0.02, .period_s = 0.04}));
        int intervals = 0;
        for (; governor.level(0) == 1.0F && intervals < 10; ++intervals)
            static_cast<void>(governor.step(rate_hz, kStep));
        EXPECT_EQ(intervals, RateFilter::kLows);
        EXPECT_EQ(governor.paths()[0].reason, LevelReason::rate_low);
        return static_cast<double>(governor.level(0));
    };
    // The level at which the model says the goal is.
    EXPECT_NEAR(level_at(690.0), std::exp((690.0 / 1002.0 - 1.0) * (1.0 - 0.5) / (0.5 * 0.5)), 1e-3);
    EXPECT_NEAR(level_at(900.0), std::exp(0.8 * (900.0 / 1002.0 - 1.0)), 1e-3);
}

// A display that never pauses takes its share of the core at many levels: an error that stays is answered by ever larger
// steps, up to the eightfold.
TEST(Governor, steps_grow_while_the_display_never_pauses_and_the_error_stays) {
    for (const bool pauses : {false, true}) {
        Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh});
        const double period_s = pauses ? 0.04 : 0.02;
        for (int i = 0; i < 50; ++i)
            static_cast<void>(governor.update({.work_s = 0.02, .processor_s = 0.01, .period_s = period_s}));
        std::vector<double> steps;
        for (int i = 0; i < 300 && steps.size() < 10; ++i) {
            const auto before = static_cast<double>(governor.level(0));
            static_cast<void>(governor.step(970.0, kStep));
            const double by = std::log(before / static_cast<double>(governor.level(0)));
            if (by > 0.0) steps.push_back(by);
        }
        ASSERT_EQ(steps.size(), 10U);
        EXPECT_NEAR(steps.back() / steps.front(), pauses ? 1.0 : 8.0, 0.2) << pauses;
    }
}

TEST(Governor, the_elastic_law_rises_only_after_a_hold_and_by_small_steps) {
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh});
    ASSERT_TRUE(governor.step(300.0, kStep));
    const float low = governor.level(0);
    for (int i = 0; i < 4; ++i) {
        static_cast<void>(governor.step(2000.0, kStep));
        EXPECT_FLOAT_EQ(governor.level(0), low);
    }
    while (governor.level(0) < 1.0F) {
        const float before = governor.level(0);
        ASSERT_TRUE(governor.step(2000.0, kStep));
        ASSERT_LE(governor.level(0), before * 1.36F);
    }
}

TEST(Governor, two_slow_frames_change_no_level_and_three_lower_it) {
    Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = 30.0}, {kMesh});
    const auto frame = [&](double work_s) {
        return governor.update(
            {.work_s = work_s, .processor_s = work_s, .period_s = std::max(work_s, 0.033)});
    };
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(frame(0.02));
    EXPECT_FALSE(frame(0.3));
    EXPECT_FALSE(frame(0.02));
    EXPECT_FALSE(frame(0.05));
    EXPECT_FALSE(frame(0.05));
    EXPECT_FALSE(frame(0.02));
    EXPECT_FALSE(frame(0.05));
    EXPECT_FALSE(frame(0.05));
    EXPECT_TRUE(frame(0.05));
    EXPECT_EQ(governor.paths()[0].reason, LevelReason::display_low);
    EXPECT_LT(governor.level(0), 0.7F);
}

TEST(Governor, without_a_display_goal_slow_frames_change_no_level) {
    Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = 0.0}, {kMesh});
    for (int i = 0; i < 10; ++i)
        EXPECT_FALSE(governor.update({.work_s = 2.0, .processor_s = 2.0, .period_s = 2.0}));
    EXPECT_FLOAT_EQ(governor.level(0), 1.0F);
}

TEST(RateFilter, detects_an_error_the_later_the_smaller_it_is) {
    RateFilter filter;
    EXPECT_EQ(filter.judge(0.003), RateIs::right);  // no measurement
    filter.add(930.0, 1000.0);
    EXPECT_EQ(filter.judge(0.003), RateIs::low);
    filter.restart();
    int n = 0;
    for (; n < 200 && filter.judge(0.003) != RateIs::low; ++n)
        filter.add(n % 2 == 0 ? 970.0 : 1010.0, 1000.0);
    EXPECT_GT(n, 5);
    EXPECT_LT(n, 200);
}

RateFilter calm_filter() {
    RateFilter filter;
    for (int i = 0; i < 100; ++i) filter.add(i % 2 == 0 ? 995.0 : 1005.0, 1000.0);
    return filter;
}

TEST(RateFilter, a_jump_is_believed_after_three_intervals_below_the_mean_or_two_above_it) {
    RateFilter low = calm_filter(), high = calm_filter();
    for (int i = 0; i < RateFilter::kLows; ++i) {
        EXPECT_NEAR(low.error(), 0.0, 1e-3);
        EXPECT_EQ(low.judge(0.003), RateIs::right);
        low.add(700.0, 1000.0);
    }
    EXPECT_DOUBLE_EQ(low.error(), -0.3);
    for (int i = 0; i < RateFilter::kHighs; ++i) {
        EXPECT_NEAR(high.error(), 0.0, 1e-3);
        high.add(1300.0, 1000.0);
    }
    EXPECT_NEAR(high.error(), 0.3, 1e-12);
}

TEST(RateFilter, one_or_two_slow_intervals_and_the_jump_back_count_for_little) {
    RateFilter filter = calm_filter();
    const double flicker = filter.flicker();
    for (int n = 0; n < 20; ++n) {
        for (int i = 0; i < 1 + n % 2; ++i) filter.add(700.0, 1000.0);
        for (int i = 0; i < 8; ++i) filter.add(i % 2 == 0 ? 995.0 : 1005.0, 1000.0);
        EXPECT_NEAR(filter.error(), 0.0, flicker);
        EXPECT_NEAR(filter.flicker(), flicker, 0.2 * flicker);
    }
    filter.restart();  // also where nothing has been measured since a change
    filter.add(700.0, 1000.0);
    EXPECT_EQ(filter.judge(0.003), RateIs::right);
}

// Another program takes a third of the core for a while: the detail that it cost returns at once, and no more than that.
TEST(Governor, what_was_lost_to_a_large_error_returns_as_soon_as_the_rate_is_too_high) {
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0, .free_running = true}, {kMesh});
    const auto level_after = [&governor](double rate_hz, int intervals) {
        for (int i = 0; i < intervals; ++i) {
            static_cast<void>(governor.update({.work_s = 0.01, .processor_s = 0.01, .period_s = 0.05}));
            static_cast<void>(governor.step(rate_hz, kStep));
        }
        return static_cast<double>(governor.level(0));
    };
    while (governor.level(0) > 0.7F) level_after(950.0, 1);
    const double before = level_after(1002.0, 10);
    const double low = level_after(700.0, 5);
    EXPECT_LT(low, 0.5 * before);
    double level = low;
    int intervals = 0;
    for (; level < 0.98 * before && intervals < 100; ++intervals) level = level_after(1030.0, 1);
    EXPECT_NEAR(level, before, 0.02 * before);
    EXPECT_LT(intervals, 40);
    level = level_after(1030.0, 10);  // then calmly
    EXPECT_GT(level, before);
    EXPECT_LT(level, 1.2 * before);
}

TEST(Governor, what_another_law_or_goal_took_does_not_return_at_once) {
    for (const bool law : {false, true}) {
        Governor governor = with(
            {.law = law ? Law::sensitus : Law::elastic, .goal_hz = 1000.0, .free_running = true}, {kMesh});
        for (int i = 0; i < 10; ++i) static_cast<void>(governor.step(600.0, kStep));
        if (law)
            governor.set_law(Law::elastic);
        else
            ASSERT_TRUE(governor.set_goal_hz(580.0));
        const double before = static_cast<double>(governor.level(0));
        EXPECT_LT(before, 0.5);
        const double rate_hz = 1.03 * governor.settings().goal_hz;
        for (int i = 0; i < 15; ++i) static_cast<void>(governor.step(rate_hz, kStep));
        EXPECT_GT(static_cast<double>(governor.level(0)), before);
        EXPECT_LT(static_cast<double>(governor.level(0)), 1.25 * before);
    }
}

TEST(Governor, the_fixed_law_keeps_the_level_that_a_person_set_at_any_rate) {
    Governor governor = with({.law = Law::fixed, .goal_hz = 1000.0}, {kMesh, kForce});
    EXPECT_FALSE(governor.step(10.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), 1.0F);
    ASSERT_TRUE(governor.set_level(0, 0.3));
    EXPECT_TRUE(governor.step(10.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), 0.3F);
    EXPECT_EQ(governor.paths()[0].reason, LevelReason::by_command);
    EXPECT_FALSE(governor.set_level(0, 0.01));  // below its floor
    EXPECT_FALSE(governor.set_level(0, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(governor.set_level(7, 0.5));
}

// 0.05 is below 0.05F.
TEST(Governor, a_floor_as_it_is_printed_and_the_present_level_are_levels_that_a_person_may_set) {
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh, kForce});
    ASSERT_TRUE(governor.set_level(0, 0.05));
    EXPECT_TRUE(governor.step(1000.0, kStep));
    EXPECT_EQ(governor.level(0), kMesh.floor);
    ASSERT_TRUE(governor.set_level(1, 1.0));
    EXPECT_FALSE(governor.step(1000.0, kStep));
    EXPECT_EQ(governor.paths()[1].reason, LevelReason::by_command);
}

TEST(Governor, a_change_to_the_fixed_law_keeps_the_present_levels) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1000.0}, {kMesh});
    static_cast<void>(governor.step(500.0, kStep));
    const float level = governor.level(0);
    governor.set_law(Law::fixed);
    EXPECT_FALSE(governor.step(10.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), level);
}

TEST(Governor, the_rate_moves_the_budget_of_a_fitted_path_only_in_a_freely_running_loop) {
    for (const bool free_running : {false, true}) {
        Governor governor =
            with({.law = Law::sensitus, .goal_hz = 1000.0, .free_running = free_running}, {kMesh, kForce});
        EXPECT_TRUE(governor.set_fitted_level(1, 0.6F, LevelReason::start));
        governor.set_present(0, false);
        for (int i = 0; i < 50; ++i) static_cast<void>(governor.step(500.0, kStep));
        EXPECT_FLOAT_EQ(governor.level(1), 0.6F);
        EXPECT_EQ(governor.paths()[1].budget < 0.5F, free_running);
        EXPECT_GE(governor.paths()[1].budget, 0.05F);
        // A display that comes back is not delayed by a budget that nobody uses.
        governor.set_present(0, true);
        static_cast<void>(governor.step(100.0, kStep));
        const float display = governor.level(0);
        EXPECT_LT(display, 1.0F);
        EXPECT_TRUE(governor.step(5000.0, kStep));
        if (!free_running) {
            EXPECT_GT(governor.level(0), display);
        }
    }
}

TEST(Governor, a_fitted_level_stays_at_or_above_the_floor_and_is_not_set_under_the_law_fixed) {
    Governor governor = with({.law = Law::sensitus, .goal_hz = 1000.0}, {kMesh, kForce});
    EXPECT_TRUE(governor.set_fitted_level(1, 0.0F, LevelReason::cost_high));
    EXPECT_FLOAT_EQ(governor.level(1), kForce.floor);
    EXPECT_FALSE(governor.set_fitted_level(1, 0.0F, LevelReason::cost_high));  // no change
    EXPECT_FALSE(
        governor.set_fitted_level(1, std::numeric_limits<float>::quiet_NaN(), LevelReason::cost_high));
    governor.set_law(Law::fixed);
    EXPECT_FALSE(governor.set_fitted_level(1, 1.0F, LevelReason::cost_low));
}

TEST(Governor, refuses_impossible_knobs_and_goals) {
    Governor governor{GovernorSettings{}};
    EXPECT_EQ(governor.add({.path = "a", .floor = 0.5F, .start = 0.2F}), Governor::kPathsMax);
    EXPECT_EQ(governor.add({.path = "b", .floor = -0.5F, .start = 0.2F}), Governor::kPathsMax);
    EXPECT_FALSE(governor.set_goal_hz(0.0));
    EXPECT_FALSE(governor.set_goal_hz(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace tact::govern_governor_test
