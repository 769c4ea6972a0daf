// The governor: the seed's law to the letter, its order of sacrifice, and what holds for any rates.
#include "rt/govern/governor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

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

TEST(SensitusLaw, is_the_equation_of_the_page) {
    // V <- V - s V (r_g - r_c) / r_g
    EXPECT_DOUBLE_EQ(sensitus_factor(600.0, 1000.0, 0.5, 0.05), 1.0 - 0.5 * (1000.0 - 600.0) / 1000.0);
    // V <- V + s V (r_c - r_g) / r_g
    EXPECT_DOUBLE_EQ(sensitus_factor(1500.0, 1000.0, 0.5, 0.05), 1.0 + 0.5 * (1500.0 - 1000.0) / 1000.0);
    // Within the tolerance, its edges included, nothing.
    EXPECT_DOUBLE_EQ(sensitus_factor(950.0, 1000.0, 0.5, 0.05), 1.0);
    EXPECT_DOUBLE_EQ(sensitus_factor(1050.0, 1000.0, 0.5, 0.05), 1.0);
}

TEST(Governor, gives_the_picture_up_first_and_the_force_last) {
    Governor governor = with({.goal_hz = 1000.0}, {kMesh, kForce});
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

TEST(Governor, restores_the_force_before_the_picture_and_no_faster_than_its_slew) {
    Governor governor = with({.goal_hz = 1000.0}, {kMesh, kForce});
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

TEST(Governor, an_absent_path_keeps_its_level_and_the_next_kind_answers) {
    Governor governor = with({.goal_hz = 1000.0}, {kMesh, kForce});
    governor.set_present(0, false);
    static_cast<void>(governor.step(500.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), 1.0F);
    EXPECT_FLOAT_EQ(governor.level(1), 0.75F);
}

// The seed's set-up: force loop and picture share a processor, so the rate is what the picture leaves.
// rate = capacity / (force + picture * V). The rest point is known in closed form.
TEST(Governor, converges_on_a_shared_processor_to_the_level_where_the_rate_is_the_goal) {
    for (const double gain : {0.1, 0.5, 1.0}) {
        Governor governor = with({.goal_hz = 800.0, .gain = gain, .tolerance = 0.02}, {kMesh});
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

TEST(Governor, a_goal_beyond_the_machine_ends_at_the_floor_and_recovers_at_once) {
    Governor governor = with({.goal_hz = 1400.0}, {kMesh});
    const auto rate_hz = [](double level) { return 1.0 / (0.8e-3 + 1.02e-3 * level); };
    for (int i = 0; i < 500; ++i)
        static_cast<void>(governor.step(rate_hz(static_cast<double>(governor.level(0))), kStep));
    EXPECT_FLOAT_EQ(governor.level(0), kMesh.floor);
    EXPECT_FALSE(governor.step(rate_hz(0.05), kStep));  // clamped: nothing winds up
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
            with({.goal_hz = 1000.0, .gain = gain, .tolerance = tolerance}, {kMesh, kForce, zero});
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

TEST(Governor, the_fixed_law_holds_what_a_person_set_whatever_the_rate) {
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

TEST(Governor, going_over_to_the_fixed_law_keeps_the_levels_as_they_are) {
    Governor governor = with({.goal_hz = 1000.0}, {kMesh});
    static_cast<void>(governor.step(500.0, kStep));
    const float level = governor.level(0);
    governor.set_law(Law::fixed);
    EXPECT_FALSE(governor.step(10.0, kStep));
    EXPECT_FLOAT_EQ(governor.level(0), level);
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
