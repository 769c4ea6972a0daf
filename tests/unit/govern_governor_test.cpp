// The governor: the published law, the order in which paths are lowered, and invariants for any input.
#include "rt/govern/display_cost.hpp"
#include "rt/govern/display_watch.hpp"
#include "rt/govern/governor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tact {
namespace {

using std::chrono::milliseconds;

constexpr KnobSpec kMesh{.path = "gui.mesh", .floor = 0.05F, .start = 1.0F};
constexpr KnobSpec kForce{
    .path = "docking.force", .floor = 0.2F, .start = 1.0F, .slew_per_s = 2.0F, .haptic = true};
constexpr Duration kStep = milliseconds(100);

Governor with(GovernorSettings settings, std::initializer_list<KnobSpec> knobs) {
    Governor governor(settings);
    for (const KnobSpec& k : knobs) EXPECT_LT(governor.add(k), Governor::kPathsMax);
    return governor;
}

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

TEST(Governor, the_elastic_law_steps_to_where_the_model_says_the_goal_is) {
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh});
    // Half of the display's cost varies (the prior), and the display uses half of the core.
    for (int i = 0; i < 50; ++i)
        static_cast<void>(governor.update({.work_s = 0.02, .processor_s = 0.02, .period_s = 0.04}));
    ASSERT_TRUE(governor.step(900.0, kStep));
    const double e = 900.0 / 1002.0 - 1.0;
    EXPECT_NEAR(static_cast<double>(governor.level(0)), std::exp(e * (1.0 - 0.5) / (0.5 * 0.5)), 1e-3);
    EXPECT_EQ(governor.paths()[0].reason, LevelReason::rate_low);
}

TEST(Governor, the_elastic_law_rises_only_after_a_hold_and_by_small_steps) {
    Governor governor = with({.law = Law::elastic, .goal_hz = 1000.0}, {kMesh});
    ASSERT_TRUE(governor.step(300.0, kStep));
    const float low = governor.level(0);
    for (int i = 0; i < 4; ++i) {
        static_cast<void>(governor.step(2000.0, kStep));
        EXPECT_FLOAT_EQ(governor.level(0), low);
    }
    for (float before = low; governor.level(0) < 1.0F; before = governor.level(0)) {
        ASSERT_TRUE(governor.step(2000.0, kStep));
        ASSERT_LE(governor.level(0), before * 1.36F);
    }
}

TEST(Governor, one_slow_frame_changes_no_level_and_two_lower_it) {
    Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = 30.0}, {kMesh});
    const auto frame = [&](double work_s) {
        return governor.update(
            {.work_s = work_s, .processor_s = work_s, .period_s = std::max(work_s, 0.033)});
    };
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(frame(0.02));
    EXPECT_FALSE(frame(0.3));
    EXPECT_FALSE(frame(0.02));
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

TEST(RateFilter, detects_a_large_error_at_once_and_a_small_one_after_several_intervals) {
    RateFilter filter;
    EXPECT_EQ(filter.judge(0.003), RateIs::right);  // no measurement
    filter.add(900.0, 1000.0);
    EXPECT_EQ(filter.judge(0.003), RateIs::low);
    filter.restart();
    int n = 0;
    for (; n < 200 && filter.judge(0.003) != RateIs::low; ++n)
        filter.add(n % 2 == 0 ? 970.0 : 1010.0, 1000.0);
    EXPECT_GT(n, 5);
    EXPECT_LT(n, 200);
}

TEST(RateFilter, a_jump_restarts_the_mean) {
    RateFilter filter;
    for (int i = 0; i < 100; ++i) filter.add(i % 2 == 0 ? 995.0 : 1005.0, 1000.0);
    filter.add(700.0, 1000.0);
    EXPECT_DOUBLE_EQ(filter.error(), -0.3);
}

TEST(DisplayCost, finds_the_elasticity_of_a_line_and_keeps_its_prior_where_nothing_moves) {
    DisplayCost moved, still;
    for (int i = 0; i < 100; ++i) {
        const double level = 0.1 + 0.8 * (i % 10) / 10.0;
        moved.add({level}, {}, 0.01 + 0.04 * level);
        still.add({0.5}, {}, 0.03);
    }
    EXPECT_NEAR(moved.at({0.5}).elasticity(), 0.02 / 0.03, 0.02);
    EXPECT_NEAR(moved.at({0.05}).elasticity(), 0.002 / 0.012, 0.05);
    EXPECT_NEAR(still.at({0.5}).elasticity(), 0.5, 1e-9);
    still.add({0.5}, {}, std::nan(""));
    still.add({0.5}, {}, -1.0);
    EXPECT_NEAR(still.at({0.5}).elasticity(), 0.5, 1e-9);
    EXPECT_NEAR(DisplayCost().at({1.0}).elasticity(), 0.5, 1e-9);
}

TEST(DisplayCost, tells_levels_apart_that_moved_differently) {
    DisplayCost cost;
    for (int i = 0; i < 200; ++i) {
        const double a = 0.2 + 0.08 * (i % 10), b = 0.1 + 0.09 * (i / 10 % 10);
        cost.add({a, 0.0, b}, {0.9, 0.0, 0.9}, 0.004 + 0.030 * a + 0.006 * b);
    }
    const auto at = cost.at({0.5, 0.0, 0.5});
    EXPECT_NEAR(at.frame_s, 0.022, 0.0005);
    EXPECT_NEAR(at.gain_s[0], 0.015, 0.001);
    EXPECT_NEAR(at.gain_s[2], 0.003, 0.0005);
    EXPECT_EQ(at.gain_s[1], 0.0);
}

TEST(DisplayCost, no_path_buys_more_than_its_reported_cost) {
    DisplayCost cost;
    for (int i = 0; i < 200; ++i) {  // both levels move together: the report alone tells them apart
        const double level = 0.2 + 0.08 * (i % 10);
        cost.add({level, 0.0, level}, {0.8, 0.0, 0.05}, 0.002 + 0.030 * level);
    }
    const auto at = cost.at({0.6, 0.0, 0.6});
    EXPECT_LE(at.gain_s[2], 0.05 * at.frame_s + 1e-12);
    EXPECT_GT(at.gain_s[0], 5.0 * at.gain_s[2]);
}

// --- several visual paths: by marginal gain ---

constexpr KnobSpec kMolecules{.path = "gui.molecules", .floor = 0.1F};
constexpr KnobSpec kResolution{.path = "gui.resolution", .floor = 0.25F, .loss = 4.0F};

// A display whose frame costs a known time at the levels.
struct PlainDisplay {
    double rest_s;
    std::array<double, 3> path_s;  // at level 1; all of it in proportion to the level

    [[nodiscard]] double frame_s(const Governor& g) const {
        double s = rest_s;
        for (std::size_t i = 0; i < 3; ++i) s += path_s[i] * static_cast<double>(g.level(i));
        return s;
    }
    bool frame(Governor& g) const {
        const double s = frame_s(g);
        DisplaySample sample{.work_s = s, .processor_s = s, .period_s = std::max(s, 0.033)};
        for (std::size_t i = 0; i < 3; ++i) sample.path_s[i] = path_s[i] * static_cast<double>(g.level(i));
        return g.update(sample);
    }
};

Governor of_display() {
    return with({.goal_hz = 1000.0, .display_goal_hz = 30.0}, {kMesh, kMolecules, kResolution});
}

TEST(Governor, lowers_the_path_that_buys_most_for_its_loss) {
    Governor governor = of_display();
    const PlainDisplay display{0.010, {0.022, 0.003, 0.005}};
    for (int i = 0; i < 4 && governor.level(0) == 1.0F; ++i) static_cast<void>(display.frame(governor));
    // Gain over loss: 22 of the mesh, 3 of the molecules, 5 / 4 of the resolution.
    EXPECT_LT(governor.level(0), 0.9F);
    EXPECT_EQ(governor.level(1), 1.0F);
    EXPECT_EQ(governor.level(2), 1.0F);
    EXPECT_EQ(governor.paths()[0].reason, LevelReason::display_low);
    EXPECT_EQ(governor.paths()[1].reason, LevelReason::start);
}

// The least of the sum of loss ln(1 / level) at a given frame time, by brute force, is where the governor ends.
TEST(Governor, ends_at_the_levels_of_least_loss_that_hold_the_frame_time) {
    Governor governor = of_display();
    const PlainDisplay display{0.006, {0.050, 0.020, 0.040}};
    for (int i = 0; i < 400; ++i) {
        static_cast<void>(display.frame(governor));
        if (i % 3 == 0) static_cast<void>(governor.step(1500.0, kStep));
    }
    const double reached_s = display.frame_s(governor);
    EXPECT_LT(reached_s, 1.06 / 30.0);
    EXPECT_GT(reached_s, 0.8 / 30.0);
    const auto loss = [](double a, double b, double c) {
        return -std::log(a) - std::log(b) - 4.0 * std::log(c);
    };
    double least = 1e9;
    for (double b = 0.1; b <= 1.0; b += 0.01)
        for (double c = 0.25; c <= 1.0; c += 0.01) {
            const double a = (reached_s - 0.006 - 0.020 * b - 0.040 * c) / 0.050;
            if (a >= 0.05 && a <= 1.0) least = std::min(least, loss(a, b, c));
        }
    const auto level = [&](std::size_t i) { return static_cast<double>(governor.level(i)); };
    EXPECT_LT(loss(level(0), level(1), level(2)), least + 0.15);
}

TEST(Governor, never_lowers_a_path_that_buys_nothing) {
    for (const bool by_force_rate : {false, true}) {
        Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = by_force_rate ? 0.0 : 30.0},
                                 {kMesh, kMolecules, kResolution, kForce});
        const PlainDisplay display{0.030, {0.030, 0.0009, 0.0}};  // molecules: less than 2 % of a frame
        for (int i = 0; i < 200; ++i) {
            static_cast<void>(display.frame(governor));
            if (by_force_rate) static_cast<void>(governor.step(500.0, kStep));
            ASSERT_EQ(governor.level(1), 1.0F) << i;
        }
        EXPECT_LT(governor.level(0), 0.5F);
        // The force rate takes what is left from the haptic path; a frame rate never does.
        EXPECT_EQ(governor.level(3) < 1.0F, by_force_rate);
    }
}

TEST(Governor, raises_first_what_costs_least_for_its_loss) {
    Governor governor = of_display();
    const PlainDisplay slow{0.010, {0.200, 0.200, 0.200}}, quick{0.002, {0.040, 0.002, 0.010}};
    for (int i = 0; i < 100; ++i) static_cast<void>(slow.frame(governor));
    ASSERT_LT(governor.level(0), 0.3F);
    ASSERT_LT(governor.level(1), 0.3F);
    float molecules = 0.0F;
    for (int i = 0; i < 400 && governor.level(1) < 1.0F; ++i) {
        static_cast<void>(quick.frame(governor));
        static_cast<void>(governor.step(1500.0, kStep));
        ASSERT_GE(governor.level(1), molecules);
        molecules = governor.level(1);
    }
    EXPECT_EQ(governor.level(1), 1.0F);
    EXPECT_LT(governor.level(0), 0.8F);
}

TEST(Governor, a_display_at_rest_neither_gives_nor_takes) {
    Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = 30.0}, {kMesh, kForce});
    for (int i = 0; i < 4; ++i)
        static_cast<void>(governor.update({.work_s = 0.08, .processor_s = 0.08, .period_s = 0.08}));
    const float mesh = governor.level(0);
    ASSERT_LT(mesh, 1.0F);
    governor.set_display_resting(true);
    for (int i = 0; i < 20; ++i) static_cast<void>(governor.step(1500.0, kStep));
    EXPECT_EQ(governor.level(0), mesh);
    static_cast<void>(governor.step(500.0, kStep));
    EXPECT_EQ(governor.level(0), mesh);
    EXPECT_LT(governor.level(1), 1.0F);  // lowering the display would buy nothing
    EXPECT_FALSE(governor.visual_can_give());
    governor.set_display_resting(false);
    EXPECT_TRUE(governor.visual_can_give());
}

TEST(Governor, any_reports_leave_every_visual_level_between_floor_and_one) {
    const bool held = rc::check([] {
        Governor governor = with({.goal_hz = 1000.0, .display_goal_hz = 30.0},
                                 {kMesh, kMolecules, kResolution, kForce, {.path = "z", .floor = 0.0F}});
        const auto number = [](int to) {
            const double nasty = *rc::gen::element(std::numeric_limits<double>::quiet_NaN(), -1.0, 1e308, 0.0,
                                                   std::numeric_limits<double>::infinity());
            return *rc::gen::weightedElement<bool>({{9, true}, {1, false}}) ? *rc::gen::inRange(0, to) * 1e-3
                                                                            : nasty;
        };
        for (int i = 0; i < 60; ++i) {
            const float force = governor.level(3);
            if (*rc::gen::inRange(0, 2) == 0) {
                static_cast<void>(governor.step(1e3 * number(5000), kStep));
            } else {
                DisplaySample sample{
                    .work_s = number(300), .processor_s = number(300), .period_s = number(300)};
                for (double& s : sample.path_s) s = number(300);
                static_cast<void>(governor.update(sample));
                RC_ASSERT(governor.level(3) == force);
            }
            for (const GovernedPath& p : governor.paths())
                RC_ASSERT(p.level >= p.knob.floor && p.level <= 1.0F);
        }
    });
    EXPECT_TRUE(held);
}

TEST(DisplayWatch, a_refined_frame_is_no_sample_and_the_next_one_is_measured_from_it) {
    DisplayWatch watch;
    DisplayReport w{.frame = 5,
                    .levels_sequence = 1,
                    .taken_at_ns = 1'000'000'000,
                    .work_s = 0.01,
                    .cpu_s = 1.0,
                    .drawn = true};
    const auto next = [&](bool refined, double cpu_s) {
        ++w.frame;
        w.refined = refined;
        w.taken_at_ns += 50'000'000;
        w.cpu_s += cpu_s;
        return watch.take(w);
    };
    EXPECT_FALSE(watch.take(w));
    EXPECT_TRUE(next(false, 0.02));
    EXPECT_FALSE(next(true, 0.5));
    const auto sample = next(false, 0.02);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->processor_s, 0.02, 1e-12);
}

TEST(DisplayWatch, returns_each_frame_that_applied_the_levels_once) {
    DisplayWatch watch;
    const Instant t = Instant{} + std::chrono::hours(1);
    DisplayReport w{.frame = 5,
                    .levels_sequence = 1,
                    .taken_at_ns = 1'000'000'000,
                    .work_s = 0.01,
                    .cpu_s = 1.0,
                    .drawn = true};
    EXPECT_FALSE(watch.take(w));  // the first frame of a process has no predecessor
    watch.asked(7, t);
    EXPECT_TRUE(watch.pending(t));
    const auto next = [&](std::uint64_t sequence) {
        ++w.frame;
        w.levels_sequence = sequence;
        w.taken_at_ns += 50'000'000;
        w.cpu_s += 0.02;
        return watch.take(w);
    };
    EXPECT_FALSE(next(6));
    EXPECT_TRUE(watch.pending(t));
    const auto look = next(7);
    ASSERT_TRUE(look);
    EXPECT_NEAR(look->processor_s, 0.02, 1e-12);
    EXPECT_NEAR(look->period_s, 0.05, 1e-12);
    EXPECT_FALSE(watch.pending(t));
    EXPECT_FALSE(watch.take(w));  // same frame
    watch.asked(9, t);
    EXPECT_FALSE(watch.pending(t + std::chrono::seconds(1)));  // a silent process blocks nothing
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
}  // namespace tact
