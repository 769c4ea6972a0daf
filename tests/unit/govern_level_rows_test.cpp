// Rows of LevelFit while the loop runs: renewed, kept for a while, foreseen.
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
    double age_s = 0.0, kept_s = 0.0;
    for (; age_s < 2.5 * LevelFit::kKept_s; age_s += 0.03) {
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

// A contact that may come bounds the level until it has come and has shown its cost.
TEST(LevelRows, a_foreseen_cost_counts_while_it_is_foreseen_and_is_not_kept) {
    LevelFit fit = with(doubling(3, 10.0));
    EXPECT_TRUE(fit.renew(1, 1 * kUs, 0.1, 100 * kUs));
    EXPECT_NEAR(fit.rows()[1].cost_s, 100 * kUs, 1e-12);
    EXPECT_FALSE(fit.renew(1, 2 * kUs, 0.1));
    EXPECT_NEAR(fit.rows()[1].cost_s, 2 * kUs, 1e-12);
    EXPECT_FALSE(fit.renew(1, 1 * kUs, 0.1, NAN));
    EXPECT_NEAR(fit.rows()[1].cost_s, 2 * kUs, 1e-12);
}

// A level is chosen between rows that remember the same time: one that forgot its dear contact first would look best.
TEST(LevelRows, all_rows_forget_in_the_same_cycle) {
    LevelFit fit = with(doubling(3, 10.0));
    for (std::size_t i = 0; i < 3; ++i) static_cast<void>(fit.renew(i, 100 * kUs, 5.0));
    int forgot = 0;
    for (int cycle = 0; cycle < 400; ++cycle) {
        fit.pass(0.03);
        static_cast<void>(fit.renew(static_cast<std::size_t>(cycle) % 3, 1 * kUs, 0.1, 60 * kUs));
        int now = 0;
        for (const LevelFit::Row& row : fit.rows()) now += row.error < 5.0 ? 1 : 0;
        EXPECT_TRUE(now == 0 || now == 3) << cycle;
        forgot = std::max(forgot, now);
        // Forgetting leaves what is foreseen.
        for (const LevelFit::Row& row : fit.rows()) EXPECT_GE(row.cost_s, 60 * kUs) << cycle;
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

}  // namespace
}  // namespace tact::govern_level_rows_test
