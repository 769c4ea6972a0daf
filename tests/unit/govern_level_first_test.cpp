// The first haptic level, after dry steps that told much or little.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/govern_level_rows.hpp"

namespace tact::govern_level_first_test {
namespace {

using test::kUs;
using test::with;

const LevelFit::Limits kLimits{.period_s = 1000 * kUs, .deadline_s = 700 * kUs};
constexpr double kRestUs = 10.0;

// Rows of 200 us and of `costly_us`, measured; then so many dry steps, of which each tenth costs `tenth` times as much.
float first_level(double costly_us, int steps, double tenth, LevelFit::Limits limits = kLimits) {
    LevelFit fit = with({{0.0F, 200 * kUs, 1.0}, {1.0F, costly_us * kUs, 0.1}});
    float level = 0.0F;
    while (fit.calibrating(level)) fit.calibrate(level > 0.5F ? costly_us * kUs : 200 * kUs, kRestUs * kUs);
    float chosen = fit.choose(limits);
    for (int i = 0; i < steps; ++i) {
        const double usual_s = fit.rows()[fit.row()].cost_s;
        static_cast<void>(fit.learn({.level = chosen,
                                     .model_s = (i % 10 == 0 ? tenth : 1.0) * usual_s,
                                     .predicted_s = usual_s,
                                     .rest_s = kRestUs * kUs,
                                     .dt_s = limits.period_s}));
        chosen = fit.choose(limits);
    }
    return chosen;
}

// 650 + 10 of 700 us.
TEST(LevelFirst, steps_that_are_alike_leave_nearly_all_of_the_budget_to_the_first_level) {
    EXPECT_EQ(first_level(650, 1000, 1.0), 1.0F);
    EXPECT_EQ(first_level(665, 1000, 1.0), 0.0F);  // above kFirst of it
}

TEST(LevelFirst, after_few_steps_or_unequal_ones_the_first_level_keeps_its_distance) {
    EXPECT_EQ(first_level(650, 100, 1.0), 0.0F);
    EXPECT_EQ(first_level(510, 100, 1.0), 1.0F);  // 510 x 1.16 + 10 <= 0.88 x 700
    EXPECT_EQ(first_level(540, 1000, 1.12), 0.0F);
    EXPECT_EQ(first_level(540, 1000, 1.0), 1.0F);
}

// The other programs of its core are not there yet.
TEST(LevelFirst, the_first_level_of_a_freely_running_loop_stays_within_the_budget) {
    const LevelFit::Limits free{.period_s = 1000 * kUs, .deadline_s = 900 * kUs, .free_running = true};
    EXPECT_EQ(first_level(590, 1000, 1.0, free), 1.0F);  // 1.1 x 590 + 10 <= 0.96 x 700
    EXPECT_EQ(first_level(650, 1000, 1.0, free), 0.0F);
}

// Runs for some seconds without a change of cost. Returns the row.
std::size_t run(LevelFit& fit, double seconds, double times = 1.0) {
    for (int i = 0; i < std::lround(1e3 * seconds); ++i) {
        const double cost_s = times * fit.rows()[fit.row()].cost_s;
        fit.pass(kLimits.period_s);
        static_cast<void>(fit.add({.level = fit.rows()[fit.row()].level,
                                   .model_s = cost_s,
                                   .rest_s = kRestUs * kUs,
                                   .dt_s = kLimits.period_s,
                                   .deadline_missed = cost_s > kLimits.deadline_s},
                                  kLimits));
    }
    return fit.row();
}

TEST(LevelFirst, in_its_first_ten_seconds_a_level_rises_above_its_first_choice_only_to_halve_the_error) {
    for (const double error : {0.6, 0.4}) {
        LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 650 * kUs, error}});
        ASSERT_EQ(fit.choose(kLimits), 0.0F);
        fit.pass(LevelFit::kKept_s);
        static_cast<void>(fit.renew(0, 100 * kUs, 1.0));
        static_cast<void>(fit.renew(1, 200 * kUs, error));  // it fits from now on
        for (int i = 0; i < 2; ++i) {
            fit.pass(LevelFit::kKept_s);
            static_cast<void>(fit.renew(0, 100 * kUs, 1.0));
            static_cast<void>(fit.renew(1, 200 * kUs, error));
        }
        EXPECT_EQ(run(fit, 8.0), error < 0.5 ? 1U : 0U);
        EXPECT_EQ(run(fit, 4.0), 1U);
    }
}

TEST(LevelFirst, a_level_returns_to_its_first_choice_as_before) {
    LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 400 * kUs, 0.6}});
    ASSERT_EQ(fit.choose(kLimits), 1.0F);
    ASSERT_EQ(run(fit, 0.1, 2.0), 0U);
    ASSERT_EQ(run(fit, 0.1), 0U);
    for (int i = 0; i < 3; ++i) fit.pass(LevelFit::kKept_s);  // the slow steps are forgotten
    EXPECT_EQ(run(fit, 3.0), 1U);
}

// A contact costs what no dry step has shown.
TEST(LevelFirst, a_cost_that_no_dry_step_reaches_keeps_its_distance) {
    LevelFit fit = with({{0.0F, 200 * kUs, 1.0}, {1.0F, 560 * kUs, 0.1}});
    float level = 0.0F;
    while (fit.calibrating(level)) fit.calibrate(20 * kUs, kRestUs * kUs);
    for (int i = 0; i < 1000; ++i)
        static_cast<void>(
            fit.learn({.level = 0.0F, .model_s = 200 * kUs, .predicted_s = 200 * kUs, .dt_s = 1e-3}));
    EXPECT_EQ(fit.choose(kLimits), 0.0F);
}

}  // namespace
}  // namespace tact::govern_level_first_test
