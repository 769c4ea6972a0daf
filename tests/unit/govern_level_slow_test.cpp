// The haptic level on a processor that is slow for single steps, for bursts and for seconds.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/unit/govern_level_rows.hpp"

namespace tact::govern_level_slow_test {
namespace {

using test::kUs;
using test::with;

constexpr double kPeriodUs = 1000.0, kDeadlineUs = 700.0, kRestUs = 10.0;

// A loop at 1 kHz whose steps cost `times` as much as predicted.
struct Loop {
    LevelFit& fit;
    LevelFit::Limits limits{.period_s = kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs};
    double predicted = 1.0;  // of the row's cost
    int changes = 0, misses = 0;

    void step(double times) {
        const double predicted_us = predicted * fit.rows()[fit.row()].cost_s / kUs;
        const double whole_us = times * predicted_us, took_us = std::min(whole_us, kDeadlineUs + 5.0);
        const bool missed = took_us > kDeadlineUs;
        fit.pass(limits.period_s);
        const LevelFit::Choice choice = fit.add({.level = fit.rows()[fit.row()].level,
                                                 .model_s = kUs * took_us,
                                                 .predicted_s = kUs * predicted_us,
                                                 .work_done = took_us / whole_us,
                                                 .rest_s = kUs * kRestUs,
                                                 .dt_s = limits.period_s,
                                                 .deadline_missed = missed},
                                                limits);
        changes += choice.changed ? 1 : 0;
        misses += missed ? 1 : 0;
    }
    void run(int steps, double times) {
        for (int i = 0; i < steps; ++i) step(times);
    }
};

// Two steps in a hundred are slow by themselves. While all are, none is slower still.
TEST(LevelSlow, a_processor_that_is_slow_for_steps_and_for_seconds_is_not_slow_twice) {
    LevelFit fit = with({{0.0F, 200 * kUs, 1.0}, {1.0F, 400 * kUs, 0.1}});
    Loop loop{fit};
    ASSERT_EQ(fit.choose(loop.limits), 1.0F);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> of_all(0.0, 1.0);
    for (int phase = 0; phase < 20; ++phase) {
        for (int i = 0; i < 1500; ++i) loop.step(of_all(random) < 0.02 ? 1.5 : 1.0);
        loop.run(500, 1.5);
    }
    EXPECT_EQ(loop.changes, 0);
    EXPECT_EQ(loop.misses, 0);
    // But what does not fit at that speed is not chosen: 440 x 1.5 > 0.88 x 700.
    LevelFit larger = with({{0.0F, 200 * kUs, 1.0}, {1.0F, 440 * kUs, 0.1}});
    Loop beside{larger, {.period_s = 0.5 * kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs}};
    ASSERT_EQ(larger.choose(beside.limits), 0.0F);
    for (int i = 0; i < 20'000; ++i) {
        beside.step(of_all(random) < 0.02 ? 1.5 : 1.0);
        if (i == 2000) beside.limits = loop.limits;
    }
    EXPECT_EQ(beside.changes, 0);
}

// What happens once in ten seconds is forgotten ten seconds later.
TEST(LevelSlow, a_slow_second_is_forgotten_after_five_to_ten) {
    LevelFit fit = with({{0.0F, 200 * kUs, 1.0}, {1.0F, 440 * kUs, 0.1}});
    Loop loop{fit};
    ASSERT_EQ(fit.choose(loop.limits), 1.0F);
    loop.run(1000, 1.0);
    loop.run(1000, 1.7);
    ASSERT_EQ(fit.row(), 0U);
    loop.run(3000, 1.0);
    EXPECT_EQ(fit.row(), 0U);
    loop.run(8000, 1.0);
    EXPECT_EQ(fit.row(), 1U);
    EXPECT_EQ(loop.changes, 2);
}

// They are followed at once where more than those of a burst cost nearly what the level may.
TEST(LevelSlow, ten_slow_steps_in_a_row_that_miss_nothing_change_nothing_and_sixteen_do) {
    LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 270 * kUs, 0.1}});
    Loop loop{fit, {.period_s = kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs}, 0.7};
    ASSERT_EQ(fit.choose(loop.limits), 1.0F);
    loop.run(6000, 1.0);
    loop.run(10, 2.58);  // the whole level would not fit
    loop.run(3000, 1.0);
    EXPECT_EQ(loop.changes, 0);
    loop.run(20, 2.58);
    EXPECT_EQ(loop.changes, 1);
    EXPECT_EQ(loop.misses, 0);
}

// Steps that cost a part of what the level may: there is time to see whether it passes.
TEST(LevelSlow, a_burst_of_slow_steps_is_over_as_soon_as_they_end) {
    LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 300 * kUs, 0.1}});
    Loop loop{fit, {.period_s = kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs}, 0.5};
    ASSERT_EQ(fit.choose(loop.limits), 1.0F);
    loop.run(6000, 1.0);
    loop.run(80, 2.75);
    loop.run(3000, 1.0);
    EXPECT_EQ(loop.changes, 0);
    loop.run(160, 2.75);
    EXPECT_EQ(loop.changes, 1);
}

TEST(LevelSlow, bursts_that_come_again_lower_the_level) {
    LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 290 * kUs, 0.1}});
    Loop loop{fit};
    ASSERT_EQ(fit.choose(loop.limits), 1.0F);
    for (int burst = 0; burst < 5; ++burst) {
        loop.run(1000, 1.0);
        loop.run(8, 2.4);
    }
    EXPECT_EQ(fit.row(), 0U);
    EXPECT_EQ(loop.misses, 0);
}

// Five steps in a thousand, of steps that seldom cost what their level may: the level may be kept, but none is chosen anew.
TEST(LevelSlow, another_level_must_fit_the_slowest_speed_of_the_last_seconds) {
    LevelFit fit = with({{0.0F, 200 * kUs, 1.0}, {1.0F, 440 * kUs, 0.1}});
    Loop loop{fit, {.period_s = 0.5 * kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs}, 0.6};
    ASSERT_EQ(fit.choose(loop.limits), 0.0F);
    loop.run(7000, 1.0);
    loop.run(50, 1.7);
    loop.limits.period_s = kUs * kPeriodUs;
    loop.run(4000, 1.0);
    EXPECT_EQ(loop.changes, 0);
    loop.run(8000, 1.0);
    EXPECT_EQ(fit.row(), 1U);
}

TEST(LevelSlow, a_miss_after_a_fall_lowers_nothing_by_itself) {
    LevelFit fit = with(test::doubling(8, 5.0));
    Loop loop{fit};
    static_cast<void>(fit.choose(loop.limits));
    loop.run(2000, 1.0);
    loop.run(3, 6.0);
    ASSERT_EQ(loop.changes, 1);
    loop.run(1, 100.0);
    EXPECT_EQ(loop.misses, 4);
    loop.run(400, 1.0);
    EXPECT_EQ(loop.changes, 1);
}

// A model predicts too much while it hardly touches. Faster than measured before the start counts after five seconds.
TEST(LevelSlow, steps_that_cost_less_than_predicted_raise_a_freely_running_loop_after_seconds) {
    LevelFit fit = with({{0.0F, 300 * kUs, 1.0}, {1.0F, 600 * kUs, 0.1}});
    Loop loop{fit, {.period_s = kUs * kPeriodUs, .deadline_s = kUs * kDeadlineUs, .free_running = true}};
    ASSERT_EQ(fit.choose(loop.limits), 0.0F);
    loop.run(1000, 1.0);
    loop.run(3000, 0.75);
    EXPECT_EQ(loop.changes, 0);
    loop.run(8000, 0.75);
    EXPECT_EQ(fit.row(), 1U);
}

}  // namespace
}  // namespace tact::govern_level_slow_test
