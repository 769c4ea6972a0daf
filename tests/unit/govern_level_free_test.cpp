// LevelFit of a freely running loop: its core is shared, so it is held by its mean and its deadline.
#include <gtest/gtest.h>

#include "tests/unit/govern_level_rows.hpp"

namespace tact::govern_level_free_test {
namespace {

using test::kUs;
using test::Rows;
using test::with;

// Other programs interrupt every fifth step for half a millisecond: the mean still keeps the goal, and no cycle is late.
TEST(LevelFitFreeRunning, a_freely_running_loop_is_held_by_its_mean_and_its_deadline) {
    const Rows rows{{0.0F, 50 * kUs, 1.0}, {1.0F, 500 * kUs, 0.0}};
    const auto level_after = [&](bool free_running, double deadline_s) {
        LevelFit fit = with(rows);
        const LevelFit::Limits limits{
            .period_s = 1e-3, .deadline_s = deadline_s, .free_running = free_running};
        float level = fit.choose(limits);
        for (int i = 0; i < 20000; ++i) {
            const double usual_us = level > 0.5F ? 500.0 : 50.0,
                         whole_us = i % 5 == 0 ? usual_us + 500.0 : usual_us;
            level =
                fit.add(
                       {.level = level, .model_s = kUs * whole_us, .rest_s = 5 * kUs, .dt_s = kUs * whole_us},
                       limits)
                    .level;
        }
        return level;
    };
    EXPECT_EQ(level_after(true, 0.1), 1.0F);
    EXPECT_EQ(level_after(true, 600 * kUs), 0.0F);
    EXPECT_EQ(level_after(false, 0.1), 0.0F);
}

// The kernel gives other programs the core for milliseconds, five times a second: no level bears that. One of 100 us is borne.
TEST(LevelFitFreeRunning, interrupts_that_no_level_could_bear_lower_none) {
    for (const bool free_running : {true, false}) {
        const auto level_after = [&](double interrupt_us) {
            LevelFit fit = with({{0.0F, 50 * kUs, 1.0}, {1.0F, 527 * kUs, 0.0}});
            const LevelFit::Limits limits{
                .period_s = 1e-3, .deadline_s = 700 * kUs, .free_running = free_running};
            float level = fit.choose(limits);
            for (int i = 0; i < 40000; ++i) {
                const double usual_us = level > 0.5F ? 527.0 : 50.0,
                             whole_us = i % 400 == 399 ? usual_us + interrupt_us : usual_us;
                level = fit.add({.level = level,
                                 .model_s = kUs * whole_us,
                                 .rest_s = 5 * kUs,
                                 .dt_s = kUs * std::max(whole_us, 1000.0),
                                 .deadline_missed = whole_us > 700.0},
                                limits)
                            .level;
            }
            return level;
        };
        EXPECT_EQ(level_after(100.0), 1.0F) << free_running;
        EXPECT_EQ(level_after(400.0), 0.0F) << free_running;
        EXPECT_EQ(level_after(3000.0), 1.0F) << free_running;
    }
}

// Another program holds the core for some steps. That says nothing of the level.
TEST(LevelFitFreeRunning, a_freely_running_loop_is_not_lowered_by_three_misses_in_a_row_and_is_by_four) {
    for (const int held : {1, 2, 3, 4}) {
        LevelFit fit = with({{0.0F, 50 * kUs, 1.0}, {1.0F, 300 * kUs, 0.0}});
        const LevelFit::Limits limits{.period_s = 1e-3, .deadline_s = 600 * kUs, .free_running = true};
        float level = fit.choose(limits);
        for (int i = 0; i < 3000 + held; ++i) {
            const bool late = i >= 3000;
            const double us = late ? 1500.0 : level > 0.5F ? 300.0 : 50.0;
            level = fit.add({.level = level,
                             .model_s = kUs * us,
                             .work_done = late ? 0.8 : 1.0,
                             .rest_s = 5 * kUs,
                             .dt_s = kUs * us,
                             .deadline_missed = late},
                            limits)
                        .level;
        }
        EXPECT_EQ(level, held < 4 ? 1.0F : 0.0F) << held;
        if (held < 4) {
            // Now and again.
            for (int i = 0; i < 4000; ++i) {
                const bool late = i % 100 >= 100 - held;
                level = fit.add({.level = level,
                                 .model_s = kUs * (late ? 1500.0 : 300.0),
                                 .work_done = late ? 0.8 : 1.0,
                                 .rest_s = 5 * kUs,
                                 .dt_s = 300 * kUs,
                                 .deadline_missed = late},
                                limits)
                            .level;
            }
            EXPECT_EQ(level, 1.0F) << held;
        }
    }
}

}  // namespace
}  // namespace tact::govern_level_free_test
