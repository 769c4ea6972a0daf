// Rows of LevelFit while the loop runs: renewed, kept for a while, seldom reached.
#include <gtest/gtest.h>

#include "tests/unit/govern_level_rows.hpp"

namespace tact::govern_level_rows_test {
namespace {

using test::doubling;
using test::kUs;
using test::with;

TEST(LevelRows, the_largest_predicted_cost_and_error_of_the_last_seconds_count) {
    LevelFit fit = with(doubling(3, 10.0));
    EXPECT_TRUE(fit.renew(1, 100 * kUs, 5.0));
    // Unfaded for kKept_s at least, and for twice as long at most, however seldom a row is renewed.
    double kept_s = 0.0;
    for (int i = 0; 0.03 * i < 2.5 * LevelFit::kKept_s; ++i) {
        const double age_s = 0.03 * i;
        fit.pass(0.03);
        EXPECT_FALSE(fit.renew(1, 1 * kUs, 0.1));
        if (fit.rows()[1].cost_s < 100 * kUs || fit.rows()[1].error < 5.0) continue;
        kept_s = age_s;
    }
    EXPECT_GT(kept_s, LevelFit::kKept_s - 0.05);
    EXPECT_LT(kept_s, 2.0 * LevelFit::kKept_s + 0.05);
    EXPECT_NEAR(fit.rows()[1].cost_s, 1 * kUs, 1e-12);
    EXPECT_NEAR(fit.rows()[1].error, 0.1, 1e-12);
    EXPECT_FALSE(fit.renew(1, NAN, 0.0));
    EXPECT_FALSE(fit.renew(7, 1.0, 0.0));
    EXPECT_NEAR(fit.rows()[1].cost_s, 1 * kUs, 1e-12);
    std::vector<bool> due(3);
    for (int i = 0; i < 3; ++i) {
        due[fit.due()] = true;
        static_cast<void>(fit.learn({}));
    }
    EXPECT_EQ(due, std::vector<bool>(3, true));
}

// A contact begins, and its cost does not leap: rows that still have the error of free space would seem better than the present one.
TEST(LevelRows, an_error_that_leaps_calls_for_all_rows) {
    LevelFit fit = with({{.level = 0.5F, .cost_s = 90 * kUs}, {.level = 1.0F, .cost_s = 100 * kUs}});
    EXPECT_FALSE(fit.renew(1, 100 * kUs, 0.0));
    EXPECT_TRUE(fit.renew(1, 100 * kUs, 0.5));
    EXPECT_FALSE(fit.renew(1, 100 * kUs, 0.52));
    EXPECT_TRUE(fit.renew(1, 100 * kUs, 0.7));
}

// One step in 200 takes 1.4 times what it was predicted. Where all steps are predicted to cost what their row does, that needs
// room; where one in twenty is, too seldom for it.
TEST(LevelRows, a_row_that_steps_seldom_reach_needs_less_room_for_its_spread) {
    const LevelFit::Limits limits{.period_s = 200 * kUs / LevelFit::kUse};
    for (const int reached_of : {1, 20}) {
        LevelFit fit = with({{.level = 0.5F, .cost_s = 10 * kUs, .error = 2.0},
                             {.level = 1.0F, .cost_s = 150 * kUs, .error = 1.0}});
        ASSERT_EQ(fit.choose(limits), 1.0F);
        for (int i = 0; i < 20000; ++i) {
            const double predicted_s = i % reached_of == 0 ? 150 * kUs : 100 * kUs;
            static_cast<void>(fit.learn({.model_s = (i % 200 == 7 ? 1.4 : 1.0) * predicted_s,
                                         .predicted_s = predicted_s,
                                         .dt_s = 1e-3}));
        }
        EXPECT_EQ(fit.choose(limits), reached_of == 1 ? 0.5F : 1.0F) << reached_of;
    }
}

// Not for seconds after the contact has shown that it costs less, and in free space for as long as it is foreseen.
TEST(LevelRows, what_a_contact_is_foreseen_to_cost_counts_as_long_as_it_is_foreseen) {
    LevelFit fit = with(doubling(3, 10.0));
    EXPECT_TRUE(fit.renew(1, 5 * kUs, 0.0, 100 * kUs));
    for (int i = 0; 0.03 * i < 3.0 * LevelFit::kKept_s; ++i) {
        fit.pass(0.03);
        EXPECT_EQ(fit.rows()[1].cost_s, 100 * kUs);
        if (i % 20 == 0) {
            EXPECT_FALSE(fit.renew(1, 5 * kUs, 0.0, 100 * kUs));
        }
    }
    EXPECT_FALSE(fit.renew(1, 40 * kUs, 0.0));
    EXPECT_EQ(fit.rows()[1].cost_s, 40 * kUs);
    EXPECT_FALSE(fit.renew(1, 5 * kUs, 0.0));
    EXPECT_EQ(fit.rows()[1].cost_s, 40 * kUs);
    EXPECT_TRUE(fit.renew(1, 5 * kUs, 0.0, 100 * kUs));
    EXPECT_FALSE(fit.renew(1, 5 * kUs, 0.0, NAN));
    EXPECT_EQ(fit.rows()[1].cost_s, 100 * kUs);
}

// A level is chosen between rows that remember the same time: one that forgot its dear contact first would look best.
TEST(LevelRows, all_rows_forget_in_the_same_cycle) {
    LevelFit fit = with(doubling(3, 10.0));
    for (std::size_t i = 0; i < 3; ++i) static_cast<void>(fit.renew(i, 100 * kUs, 5.0));
    int forgot = 0;
    for (int cycle = 0; cycle < 400; ++cycle) {
        fit.pass(0.03);
        static_cast<void>(fit.renew(static_cast<std::size_t>(cycle) % 3, 1 * kUs, 0.1));
        int now = 0;
        for (const LevelFit::Row& row : fit.rows()) now += row.error < 5.0 ? 1 : 0;
        EXPECT_TRUE(now == 0 || now == 3) << cycle;
        forgot = std::max(forgot, now);
    }
    EXPECT_EQ(forgot, 3);
}

// What a step measured is never predicted below by a renewal.
TEST(LevelRows, a_renewed_cost_is_at_least_the_calibrated_one) {
    LevelFit fit = with(doubling(2, 1.0));
    float level = 0.0F;
    while (fit.calibrating(level)) fit.calibrate(50 * kUs, 1 * kUs);
    EXPECT_FALSE(fit.renew(0, 1 * kUs, 0.0));
    EXPECT_NEAR(fit.rows()[0].cost_s, 50 * kUs, 1e-12);
}

// The processor slows by 1.58, with which the row no longer fits, while steps cost only a part of what the row may.
TEST(LevelRows,
     slow_steps_lower_the_level_at_once_where_they_near_the_budget_and_else_after_a_tenth_of_a_second) {
    for (const bool costly : {false, true}) {
        LevelFit fit = with(doubling(4, 57.0));
        const LevelFit::Limits limits{.period_s = 1e-3};
        ASSERT_EQ(fit.choose(limits), 1.0F);
        const double predicted_us = costly ? 456.0 : 240.0;
        const auto cycles_until_lower = [&](double times, int most) {
            for (int i = 0; i < most; ++i) {
                static_cast<void>(fit.add({.level = 1.0F,
                                           .model_s = times * predicted_us * kUs,
                                           .predicted_s = predicted_us * kUs,
                                           .dt_s = 1e-3},
                                          limits));
                if (fit.row() < 3) return i;
            }
            return most;
        };
        EXPECT_EQ(cycles_until_lower(1.0, 4000), 4000);
        if (costly) {
            EXPECT_LE(cycles_until_lower(1.58, 40), 20);
        } else {
            EXPECT_EQ(cycles_until_lower(1.58, 40), 40);
            EXPECT_EQ(cycles_until_lower(1.0, 2000), 2000);  // a short run changes nothing
            EXPECT_NEAR(cycles_until_lower(1.58, 400), 120, 32);
        }
    }
}

}  // namespace
}  // namespace tact::govern_level_rows_test
