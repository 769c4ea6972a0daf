// Choice of the haptic level: smallest error that fits, whole costs, misses, interrupts, no hunting.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/unit/govern_level_rows.hpp"

namespace tact::govern_level_fit_test {
namespace {

using test::doubling;
using test::kUs;
using test::Rows;
using test::with;

// A loop whose steps cost `cost_us` of their row. The deadline ends a step, which has then done a part of its work.
class Loop {
public:
    Loop(LevelFit& fit, double period_us, double other_us = 10.0)
        : fit_(fit), period_us_(period_us), other_us_(other_us) {
        level_ = fit.choose(limits());
    }
    [[nodiscard]] LevelFit::Limits limits() const {
        return {
            .period_s = kUs * period_us_, .deadline_s = 0.7 * kUs * period_us_, .free_running = free_running};
    }
    void run(int cycles, const std::function<double(std::size_t row)>& cost_us) {
        const double deadline_us = 0.7 * period_us_;
        for (int i = 0; i < cycles; ++i) {
            const double whole_us = cost_us(fit_.row()), took_us = std::min(whole_us, deadline_us + 5.0);
            cost_us_.push_back(whole_us + other_us_);
            const bool missed = took_us > deadline_us;
            misses += missed ? 1 : 0;
            fit_.pass(kUs * period_us_);
            const LevelFit::Choice choice =
                fit_.add({.level = level_,
                          .model_s = kUs * took_us,
                          .predicted_s = predicted_us ? kUs * predicted_us(fit_.row()) : 0.0,
                          .work_done = took_us / whole_us,
                          .rest_s = kUs * other_us_,
                          .dt_s = kUs * period_us_,
                          .deadline_missed = missed},
                         limits());
            changes += choice.changed ? 1 : 0;
            level_ = choice.level;
        }
    }
    [[nodiscard]] double p999_us(std::size_t last) const {
        std::vector<double> costs(cost_us_.end() - static_cast<std::ptrdiff_t>(last), cost_us_.end());
        std::sort(costs.begin(), costs.end());
        return costs[static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(last))) - 1];
    }
    int misses = 0, changes = 0;
    bool free_running = false;
    std::function<double(std::size_t row)> predicted_us;  // by the model, for each step; empty: by the row

private:
    LevelFit& fit_;
    double period_us_, other_us_;
    float level_ = 0.0F;
    std::vector<double> cost_us_;
};

TEST(LevelFit, the_first_choice_is_the_row_of_least_error_among_those_that_fit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> cost_us(1.0, 1500.0), error(0.0, 1.0);
    int compared = 0;
    for (int n = 0; n < 500; ++n) {
        Rows rows;
        for (int i = 0; i < 12; ++i)
            rows.push_back({.level = static_cast<float>(i) / 11.0F,
                            .cost_s = kUs * cost_us(random),
                            .error = error(random)});
        LevelFit fit = with(rows);
        const float chosen = fit.choose({.period_s = 1e-3});
        // A new row fits a spread of 1.16 and uses at most 88 % of the limit.
        const double most_s = 0.88 * 0.7e-3 / 1.16;
        double least_error = 1e9, least_cost_s = 1e9;
        float wanted = -1.0F;
        bool at_the_edge = false;
        for (const auto& row : rows) {
            at_the_edge = at_the_edge || std::abs(row.cost_s / most_s - 1.0) < 0.01;
            if (row.cost_s <= most_s) least_error = std::min(least_error, row.error);
        }
        for (const auto& row : rows) {
            if (row.cost_s > most_s || row.error > 1.05 * least_error || row.cost_s > least_cost_s) continue;
            least_cost_s = row.cost_s;
            wanted = row.level;
        }
        if (wanted >= 0.0F && !at_the_edge) {
            EXPECT_EQ(chosen, wanted);
            ++compared;
        }
    }
    EXPECT_GT(compared, 300);
}

TEST(LevelFit, time_that_buys_no_accuracy_is_not_spent) {
    // Half of the error is worth four times the time, four hundredths of it are not.
    EXPECT_EQ(with({{0.0F, 50 * kUs, 1.0}, {0.5F, 200 * kUs, 0.5}, {1.0F, 400 * kUs, 0.48}})
                  .choose({.period_s = 1e-3}),
              0.5F);
    // At equal costs the highest level.
    EXPECT_EQ(with({{0.0F, 50 * kUs, 1.0}, {0.5F, 50 * kUs, 1.0}, {1.0F, 50 * kUs, 1.0}})
                  .choose({.period_s = 1e-3}),
              1.0F);
}

TEST(LevelFit, where_no_level_fits_one_that_saves_nothing_is_not_worth_its_error) {
    EXPECT_EQ(with({{0.0F, 900 * kUs, 1.7}, {0.5F, 920 * kUs, 1.0}, {1.0F, 2000 * kUs, 0.9}})
                  .choose({.period_s = 1e-3}),
              0.5F);
    EXPECT_EQ(with({{0.0F, 900 * kUs, 1.7}, {0.5F, 1000 * kUs, 1.0}, {1.0F, 2000 * kUs, 0.9}})
                  .choose({.period_s = 1e-3}),
              0.0F);
    // The slow update bounds the level all the same.
    EXPECT_EQ(with({{0.0F, 900 * kUs, 1.7}, {0.5F, 920 * kUs, 1.0}, {1.0F, 2000 * kUs, 0.9}})
                  .choose({.period_s = 1e-3, .level_max = 0.4F}),
              0.0F);
}

TEST(LevelFit, where_nothing_is_felt_the_highest_level_that_fits_waits_for_the_contact) {
    EXPECT_EQ(with({{0.0F, 50 * kUs, 0.0}, {0.5F, 200 * kUs, 0.0}, {1.0F, 900 * kUs, 0.0}})
                  .choose({.period_s = 1e-3}),
              0.5F);
}

TEST(LevelFit, a_costlier_row_with_a_larger_error_is_never_chosen) {
    // A blend of two levels costs both and lies between their errors.
    LevelFit fit = with({{0.0F, 50 * kUs, 1.0}, {0.5F, 250 * kUs, 0.5}, {1.0F, 200 * kUs, 0.1}});
    EXPECT_EQ(fit.choose({.period_s = 1e-3}), 1.0F);
}

TEST(LevelFit, calibration_tries_each_row_and_measures_what_the_prediction_missed) {
    LevelFit fit = with(doubling(5, 1.0));
    float level = -1.0F;
    int tries = 0;
    while (fit.calibrating(level)) {
        const std::size_t row = static_cast<std::size_t>(std::lround(level * 4.0F));
        fit.calibrate(kUs * 100.0 * std::exp2(static_cast<double>(row)),
                      5 * kUs);  // a hundred times the prediction
        ++tries;
    }
    EXPECT_EQ(tries, 15);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(fit.rows()[i].cost_s, 100.0 * kUs * std::exp2(static_cast<double>(i)), 1e-12);
    EXPECT_EQ(fit.choose({.period_s = 1e-3}), 0.5F);
}

TEST(LevelFit, the_tail_of_the_cycle_stays_within_seven_tenths_of_the_period_at_any_rate) {
    for (const double period_us : {2000.0, 1000.0, 500.0, 250.0, 125.0}) {
        LevelFit fit = with(doubling(9, 5.0));
        Loop loop(fit, period_us);
        std::mt19937 random(7);
        std::lognormal_distribution<double> noise(0.0, 0.08);
        loop.run(20000,
                 [&](std::size_t row) { return 5.0 * std::exp2(static_cast<double>(row)) * noise(random); });
        EXPECT_LE(loop.p999_us(10000), 0.7 * period_us * 1.02) << period_us;
        EXPECT_EQ(loop.misses, 0) << period_us;
        EXPECT_LE(loop.changes, 2) << period_us;
        // No lower than necessary: the next row would not fit.
        EXPECT_GT(2.0 * loop.p999_us(10000), 0.88 * 0.7 * period_us) << period_us;
    }
}

TEST(LevelFit, a_step_cut_by_its_deadline_counts_as_the_whole_one) {
    // The true cost is four times the prediction: at the first level the deadline cuts every step.
    LevelFit fit = with(doubling(6, 20.0));
    Loop loop(fit, 1000.0);
    loop.run(2000, [](std::size_t row) { return 4.0 * 20.0 * std::exp2(static_cast<double>(row)); });
    EXPECT_LT(loop.misses, 12);
    EXPECT_LE(loop.p999_us(1000), 700.0);
    const int before = loop.misses;
    loop.run(20000, [](std::size_t row) { return 4.0 * 20.0 * std::exp2(static_cast<double>(row)); });
    EXPECT_EQ(loop.misses, before);  // the level does not rise back into the deadline
}

TEST(LevelFit, one_interrupted_step_lowers_nothing_and_misses_close_together_do) {
    LevelFit fit = with(doubling(6, 10.0));
    Loop loop(fit, 1000.0);
    const auto usual = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
    const auto interrupted = [](std::size_t) { return 5000.0; };
    const float before = fit.rows()[fit.row()].level;
    for (int i = 0; i < 10; ++i) {
        loop.run(2500, usual);
        loop.run(1, interrupted);
        EXPECT_EQ(fit.rows()[fit.row()].level, before);
    }
    loop.run(4, interrupted);
    EXPECT_LT(fit.rows()[fit.row()].level, before);
}

TEST(LevelFit, the_third_miss_within_a_thousand_cycles_lowers_the_level_at_once) {
    LevelFit fit = with(doubling(6, 10.0));
    Loop loop(fit, 321.0);
    const auto usual = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
    const auto missed = [&](std::size_t row) { return 1.5 * usual(row); };  // no interrupt
    loop.run(2500, usual);
    const std::size_t before = fit.row();
    ASSERT_GT(1.5 * usual(before), 0.7 * 321.0);
    for (int i = 0; i < 3; ++i) {
        loop.run(1, missed);
        loop.run(3000, usual);
        EXPECT_EQ(fit.row(), before);
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(fit.row(), before);
        loop.run(100, usual);
        loop.run(1, missed);
    }
    EXPECT_LT(fit.row(), before);
}

// Costs of doubling(7, 8.0) on a processor that is slower by a factor.
auto at_speed(double factor) {
    return [factor](std::size_t row) { return factor * 8.0 * std::exp2(static_cast<double>(row)); };
}

TEST(LevelFit, a_processor_that_slows_by_half_is_followed_within_a_tenth_of_a_second_and_back) {
    LevelFit fit = with(doubling(7, 8.0));
    Loop loop(fit, 1000.0);
    loop.run(3000, at_speed(1.0));
    const std::size_t fast = fit.row();
    loop.run(100, at_speed(1.45));
    EXPECT_LE(8.0 * 1.45 * std::exp2(static_cast<double>(fit.row())), 700.0);
    const int misses = loop.misses;
    loop.run(3000, at_speed(1.45));
    EXPECT_EQ(loop.misses, misses);
    loop.run(20000, at_speed(1.0));
    EXPECT_EQ(fit.row(), fast);
}

TEST(LevelFit, a_processor_that_is_slow_again_and_again_does_not_move_the_level) {
    LevelFit fit = with(doubling(7, 8.0));
    Loop loop(fit, 1000.0);
    loop.run(1000, at_speed(1.45));
    loop.changes = loop.misses = 0;
    for (int i = 0; i < 20; ++i) {
        loop.run(2500, at_speed(1.0));
        loop.run(500, at_speed(1.45));
    }
    EXPECT_EQ(loop.changes, 0);
    EXPECT_EQ(loop.misses, 0);
}

// Its core is shared and slow at times, so it does not wait.
TEST(LevelFit, a_freely_running_loop_returns_as_soon_as_its_core_is_free) {
    for (const bool free_running : {false, true}) {
        LevelFit fit = with(doubling(7, 8.0));
        Loop loop(fit, 1000.0);
        loop.free_running = free_running;
        loop.run(1000, at_speed(1.0));
        const std::size_t fast = fit.row();
        loop.run(1000, at_speed(1.45));
        EXPECT_LT(fit.row(), fast);
        loop.run(3000, at_speed(1.0));
        EXPECT_EQ(fit.row() == fast, free_running);
    }
}

TEST(LevelFit, steps_in_free_space_do_not_raise_the_level_of_a_step_in_contact) {
    LevelFit fit = with(doubling(7, 10.0));
    Loop loop(fit, 1000.0);
    const std::size_t before = fit.row();
    loop.run(30000, [](std::size_t) { return 0.5; });
    EXPECT_LE(fit.row(), before + 1);  // kSpeedLeast of the predicted cost
    const int misses = loop.misses;
    loop.run(1000, [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); });
    EXPECT_EQ(loop.misses, misses);
}

TEST(LevelFit, a_cost_at_the_edge_of_the_limit_does_not_make_the_level_hunt) {
    LevelFit fit = with(doubling(6, 20.0));
    Loop loop(fit, 1000.0);
    std::mt19937 random(5);
    std::normal_distribution<double> noise(1.0, 0.02);
    double drift = 1.0;
    loop.run(60000, [&](std::size_t row) {
        drift = std::clamp(drift + 0.001 * (noise(random) - 1.0), 0.9, 1.1);
        return 1.05 * drift * noise(random) * 20.0 * std::exp2(static_cast<double>(row));
    });
    EXPECT_LE(loop.changes, 6);
}

// A row is renewed in every cycle, as in the loop.
void renew_all(LevelFit& fit, double factor) {
    for (std::size_t i = 0; i < fit.rows().size(); ++i)
        static_cast<void>(fit.renew(i, factor * 10.0 * kUs * std::exp2(static_cast<double>(i)), 0.0));
}

TEST(LevelFit, a_leap_of_the_predicted_cost_lowers_the_level_in_the_same_cycle) {
    LevelFit fit = with(doubling(7, 10.0));
    Loop loop(fit, 1000.0);
    const auto usual = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
    loop.run(1000, usual);
    const std::size_t before = fit.row();
    renew_all(fit, 4.0);
    loop.run(1, [&](std::size_t row) { return 4.0 * usual(row); });
    EXPECT_LE(fit.row() + 2, before);
    EXPECT_LE(4.0 * usual(fit.row()), 700.0);
}

TEST(LevelFit, a_small_gain_of_error_is_not_worth_a_change_of_level) {
    for (const double error : {0.9, 0.8}) {
        LevelFit fit = with({{0.0F, 100 * kUs, 1.0}, {1.0F, 600 * kUs, error}});
        Loop loop(fit, 1000.0);
        const auto usual = [](std::size_t row) { return row == 0 ? 100.0 : 600.0; };
        loop.run(1000, usual);
        ASSERT_EQ(fit.row(), 0U);
        for (int i = 0; i < 3; ++i) {  // it fits from now on
            fit.pass(LevelFit::kKept_s);
            static_cast<void>(fit.renew(1, 200 * kUs, error));
        }
        loop.run(12'000, [](std::size_t row) { return row == 0 ? 100.0 : 200.0; });
        EXPECT_EQ(fit.row(), error < 0.85 ? 1U : 0U) << error;
    }
}

// A processor that stops twice in a row says nothing of the level; a model that suddenly costs a multiple misses until the
// level falls.
TEST(LevelFit, three_interrupted_steps_in_a_row_lower_the_level_to_what_would_have_fitted) {
    LevelFit fit = with(doubling(8, 10.0));
    Loop loop(fit, 2000.0);
    const auto usual = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
    const auto slow = [](std::size_t row) { return 6.0 * 10.0 * std::exp2(static_cast<double>(row)); };
    loop.run(500, usual);
    for (int i = 0; i < 3; ++i) {
        loop.run(2, slow);
        loop.run(1000, usual);
    }
    EXPECT_EQ(loop.changes, 0);
    const int before = loop.misses;
    loop.run(5, slow);
    EXPECT_EQ(loop.misses, before + 3);
    EXPECT_LE(slow(fit.row()), 0.7 * 2000.0);
}

// Steps that cost half as much again are no interrupts: their level costs too much.
TEST(LevelFit, two_misses_in_a_row_lower_the_level) {
    LevelFit fit = with(doubling(6, 10.0));
    Loop loop(fit, 321.0);
    const auto usual = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
    loop.run(2500, usual);
    const std::size_t before = fit.row();
    loop.run(2, [&](std::size_t row) { return 1.5 * usual(row); });
    EXPECT_EQ(loop.misses, 2);
    EXPECT_LT(fit.row(), before);
}

// A model that predicts each step: cheap steps in free space say nothing about the speed of the processor in contact.
TEST(LevelFit, only_steps_that_are_predicted_to_be_as_costly_as_their_row_measure_the_speed) {
    for (const double slower : {1.0, 1.6}) {
        LevelFit fit = with(doubling(7, 10.0));
        Loop loop(fit, 1000.0);
        const auto whole = [&](std::size_t row) {
            return slower * 10.0 * std::exp2(static_cast<double>(row));
        };
        loop.predicted_us = [](std::size_t row) { return 10.0 * std::exp2(static_cast<double>(row)); };
        loop.run(2000, whole);
        const std::size_t in_contact = fit.row();
        loop.predicted_us = [](std::size_t) { return 1.0; };
        for (const double free_us : {0.5, 4.0}) {
            loop.run(20000, [&](std::size_t) { return free_us; });
            EXPECT_EQ(fit.row(), in_contact) << slower << ", " << free_us;
        }
    }
}

// One step in 500 is interrupted for 100 us, and one in 500 is slow by itself, seldom the same.
// Its steps cost what the dry steps measured, more than the model predicts: all are as costly as their row.
TEST(LevelFit, a_row_whose_dry_steps_cost_more_than_predicted_needs_the_spread_of_all_its_steps) {
    LevelFit fit = with(doubling(3, 100.0));
    for (std::size_t i = 0; i < 3 * LevelFit::kTries; ++i)
        fit.calibrate(1.3 * fit.rows()[i / LevelFit::kTries].cost_s, 10.0 * kUs);
    Loop loop(fit, 1000.0);
    loop.predicted_us = [](std::size_t row) { return 100.0 * std::exp2(static_cast<double>(row)); };
    ASSERT_EQ(fit.row(), 2U);
    int step = 0;
    loop.run(20'000, [&step](std::size_t row) {
        return (++step % 200 == 0 ? 1.34 : 1.0) * 130.0 * std::exp2(static_cast<double>(row));
    });
    EXPECT_EQ(fit.row(), 1U);
    EXPECT_EQ(loop.changes, 1);
}

TEST(LevelFit, the_present_level_may_use_what_a_new_one_must_leave) {
    LevelFit fit = with({{.level = 0.0F, .cost_s = 100.0 * kUs, .error = 0.2},
                         {.level = 1.0F, .cost_s = 500.0 * kUs, .error = 0.1}});
    Loop loop(fit, 1000.0);
    loop.run(2000, [](std::size_t row) { return row == 0 ? 100.0 : 500.0; });
    ASSERT_EQ(fit.row(), 1U);
    loop.run(5000, [](std::size_t row) { return row == 0 ? 128.0 : 640.0; });  // 93 % of the limit
    EXPECT_EQ(loop.changes, 0);
    loop.run(2000, [](std::size_t row) { return row == 0 ? 138.0 : 690.0; });
    EXPECT_EQ(fit.row(), 0U);
}

// The first level is chosen before the spread is known. That it turns out to be small raises no level later.
TEST(LevelFit, a_calm_processor_leaves_the_level_where_it_began) {
    LevelFit fit = with({{.level = 0.0F, .cost_s = 500.0 * kUs, .error = 0.2},
                         {.level = 1.0F, .cost_s = 570.0 * kUs, .error = 0.1}});
    Loop loop(fit, 1000.0);
    loop.run(30'000, [](std::size_t row) { return row == 0 ? 500.0 : 570.0; });
    EXPECT_EQ(loop.changes, 0);
    loop.run(12'000, [](std::size_t row) { return row == 0 ? 400.0 : 456.0; });  // but a faster one does
    EXPECT_EQ(fit.row(), 1U);
}

TEST(LevelFit, slow_steps_and_interrupts_are_not_added) {
    const Rows rows{{0.0F, 80 * kUs, 1.0}, {1.0F, 160 * kUs, 0.0}};
    LevelFit fit = with(rows);
    Loop loop(fit, 500.0);
    int n = 0;
    loop.run(40000, [&](std::size_t row) {
        const double usual = row == 1 ? 160.0 : 80.0;
        ++n;
        return n % 500 == 0 ? usual + 100.0 : n % 500 == 250 ? 1.5 * usual : usual;
    });
    EXPECT_EQ(fit.row(), 1U);  // 160 x 1.5 + 100 + 10 would exceed 0.88 x 350
    EXPECT_EQ(loop.misses, 0);
}

TEST(LevelFit, a_budget_and_a_highest_level_bound_the_choice) {
    LevelFit fit = with(doubling(6, 10.0));
    const float whole = fit.choose({.period_s = 1e-3});
    EXPECT_LT(fit.choose({.period_s = 1e-3, .budget = 0.2}), whole);
    EXPECT_LE(fit.choose({.period_s = 1e-3, .level_max = 0.3F}), 0.3F);
    EXPECT_EQ(fit.choose({.period_s = 1e-6}), 0.0F);  // nothing fits: the floor
}

TEST(LevelFit, invalid_rows_are_ignored) {
    LevelFit fit;
    EXPECT_FALSE(fit.set_rows({}));
    EXPECT_EQ(fit.add({.level = 0.4F}, {}).level, 0.4F);
    const Rows bad{{0.5F, NAN, 0.0}, {0.2F, 1e-6, 1.0}, {0.1F, 1e-6, 0.5}, {2.0F, 1e-6, 0.0}};
    EXPECT_TRUE(fit.set_rows(bad));
    EXPECT_EQ(fit.rows().size(), 1U);
}

}  // namespace
}  // namespace tact::govern_level_fit_test
