// The display's side of the governor: cost of each visual path, levels by marginal gain, and the frames that count.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rt/govern/display_cost.hpp"
#include "rt/govern/display_watch.hpp"
#include "tests/unit/govern_fixture.hpp"

namespace tact::govern_display_test {
namespace {

using namespace govern_test;
using std::chrono::milliseconds;

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
        const PlainDisplay display{0.030, {0.030, 0.0005, 0.0}};  // molecules: less than 2 % of a frame
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

TEST(Governor, a_path_whose_loss_is_great_is_spared_although_it_would_buy_most) {
    Governor governor = of_display();
    const PlainDisplay display{0.0, {0.014, 0.003, 0.020}};  // gain over loss: 14, 3 and 20 / 4
    for (int i = 0; i < 4 && governor.level(0) == 1.0F; ++i) static_cast<void>(display.frame(governor));
    EXPECT_LT(governor.level(0), 0.9F);
    EXPECT_EQ(governor.level(2), 1.0F);
}

TEST(Governor, a_little_spare_time_goes_to_the_path_that_costs_least_for_its_loss) {
    Governor governor = of_display();
    const PlainDisplay slow{0.010, {0.200, 0.200, 0.200}};
    for (int i = 0; i < 100; ++i) static_cast<void>(slow.frame(governor));
    std::array<float, 3> before{};
    for (std::size_t i = 0; i < 3; ++i) before[i] = governor.level(i);
    // Gain over loss: 30, 10 and 60 / 4 of the level; 2 % below the time up to which a frame may grow.
    PlainDisplay quick{0.0, {0.030, 0.010, 0.060}};
    quick.rest_s = 0.93 / 30.0 / 1.02 - quick.frame_s(governor);
    ASSERT_GT(quick.rest_s, 0.0);
    for (int i = 0; i < 100 && governor.level(0) == before[0] && governor.level(1) == before[1]; ++i) {
        static_cast<void>(quick.frame(governor));
        static_cast<void>(governor.step(1500.0, kStep));
    }
    EXPECT_GT(governor.level(1), before[1]);
    EXPECT_EQ(governor.level(0), before[0]);
    EXPECT_EQ(governor.level(2), before[2]);
}

TEST(Governor, paths_are_balanced_again_when_their_costs_change_and_the_frame_time_stays) {
    Governor governor = of_display();
    const PlainDisplay before{0.006, {0.030, 0.004, 0.004}};
    const auto run = [&](const PlainDisplay& display) {
        for (int i = 0; i < 100; ++i) {
            static_cast<void>(display.frame(governor));
            static_cast<void>(governor.step(1000.0, kStep));
        }
    };
    run(before);
    const auto mesh = static_cast<double>(governor.level(0));
    ASSERT_LT(mesh, 0.9);
    ASSERT_EQ(governor.level(1), 1.0F);
    // The same time at these levels, but now nearly all of it is spent on the molecules.
    PlainDisplay after{0.006, {0.004 / mesh, 0.0, 0.002}};
    const double time_s = before.frame_s(governor);
    after.path_s[1] = time_s - after.frame_s(governor);
    run(after);
    EXPECT_LT(governor.level(1), 0.95F);
    EXPECT_GT(static_cast<double>(governor.level(0)), mesh);
    EXPECT_LT(after.frame_s(governor), 1.06 / 30.0);
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
    for (int i = 0; i < RateFilter::kLows; ++i) static_cast<void>(governor.step(500.0, kStep));
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

}  // namespace
}  // namespace tact::govern_display_test
