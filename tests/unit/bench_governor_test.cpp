// Pass and fail of the governor benchmark, for made-up runs.
#include "tests/bench/bench_governor.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/bench/core_speed.hpp"

namespace tact::bench_governor_test {
namespace {

const GovernorRun kGood{
    .miss_share = 0.0, .error_n = 0.11, .step_n = 0.004, .level = 0.8, .settled_s = 0.02, .rate_hz = 1000.0};
// Levels 0.6, 0.8 and 1; the last misses a tenth of its deadlines.
const std::vector<GovernorRun> kSweep{{.miss_share = 0.0, .error_n = 0.3, .step_n = 0.003, .level = 0.6},
                                      {.miss_share = 5e-4, .error_n = 0.1, .step_n = 0.003, .level = 0.8},
                                      {.miss_share = 0.1, .error_n = 0.0, .step_n = 0.2, .level = 1.0}};

bool passes(GovernorRun run) { return governor_row(run, kSweep)["passed"].get<bool>(); }

TEST(BenchGovernor, the_best_fixed_level_is_the_most_accurate_of_those_that_fit) {
    const auto row = governor_row(kGood, kSweep);
    EXPECT_EQ(row["best_fixed_level"].get<double>(), 0.8);
    EXPECT_EQ(row["best_fixed_error_n_p50"].get<double>(), 0.1);
    EXPECT_TRUE(row["passed"].get<bool>());
}

TEST(BenchGovernor, each_violated_limit_fails_the_run) {
    const auto with = [](auto change) {
        GovernorRun run = kGood;
        change(run);
        return run;
    };
    EXPECT_FALSE(passes(with([](auto& r) { r.fault = true; })));
    EXPECT_FALSE(passes(with([](auto& r) { r.miss_share = 1e-3; })));
    EXPECT_FALSE(passes(with([](auto& r) { r.error_n = 0.121; })));
    EXPECT_TRUE(passes(with([](auto& r) { r.error_n = 0.12; })));
    EXPECT_FALSE(passes(with([](auto& r) { r.step_n = 0.0061; })));
    EXPECT_FALSE(passes(with([](auto& r) { r.settled_s = 0.11; })));
}

TEST(BenchGovernor, a_run_that_never_armed_or_published_counts_as_a_fault) {
    const nlohmann::json ended = {{"ok", true}, {"why", "tact-rt ended with exit code 0"}};
    nlohmann::json report = {
        {"ended", ended},
        {"armed_cycles", 6000},
        {"deadline_miss_share", 0.25},
        {"governor", {{"paths", {{"docking.force", {{"haptic", true}, {"level", 0.5}}}}}}}};
    EXPECT_FALSE(governor_run_of(report).fault);
    EXPECT_EQ(governor_run_of(report).level, 0.5);
    EXPECT_EQ(governor_run_of(report).miss_share, 0.25);
    report["armed_cycles"] = 0;
    EXPECT_TRUE(governor_run_of(report).fault);
    EXPECT_TRUE(governor_run_of({{"ended", ended}, {"armed_cycles", 6000}}).fault);
    EXPECT_TRUE(governor_run_of({{"ended", ended}, {"armed_cycles", 6000}, {"governor", nullptr}}).fault);
    EXPECT_TRUE(governor_run_of(nlohmann::json::object()).fault);
}

TEST(BenchGovernor, a_core_is_quiet_while_a_loop_takes_the_same_time) {
    CoreSpeed speed, leaps;
    for (int i = 0; i < 100; ++i) {
        speed.note(i == 50 ? 1e-2 : 1e-3);  // one interruption
        leaps.note(i < 90 ? 1e-3 : 1.45e-3);
    }
    EXPECT_DOUBLE_EQ(speed.spread(), 1.0);
    EXPECT_NEAR(leaps.spread(), 1.45, 1e-9);
    CoreSpeed now;
    now.sample(std::chrono::milliseconds(20));
    EXPECT_GE(now.spread(), 1.0);
}

TEST(BenchGovernor, of_repeated_runs_the_median_of_each_metric_counts_and_any_fault) {
    std::vector<GovernorRun> runs(3, kGood);
    runs[0].miss_share = 0.5;
    runs[1].settled_s = 4.0;
    runs[2].error_n = 9.0;
    EXPECT_TRUE(passes(median_of(runs)));
    runs[2].settled_s = 4.0;
    EXPECT_FALSE(passes(median_of(runs)));
    runs[2] = kGood;
    runs[2].fault = true;
    EXPECT_FALSE(passes(median_of(runs)));
}

TEST(BenchGovernor, without_a_fitting_fixed_level_nothing_is_compared) {
    const auto row = governor_row(kGood, {kSweep.back()});
    EXPECT_TRUE(row["best_fixed_level"].is_null());
    EXPECT_TRUE(row["passed"].get<bool>());
}

}  // namespace
}  // namespace tact::bench_governor_test
