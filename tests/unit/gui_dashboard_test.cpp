// Data that the dashboard keeps of a run: lateness of a minute, rates, level changes; in bounded memory.
#include <gtest/gtest.h>

#include <cmath>

#include "gui/dashboard/counter_rate.hpp"
#include "gui/dashboard/knob_changes.hpp"
#include "gui/dashboard/lateness_window.hpp"

namespace tact::gui_dashboard_test {
namespace {

// A controller that counts cycles and publishes once per second.
struct Late {
    DurationHistogram histogram;
    std::int64_t now_ns = 1'000'000'000;
    void second(std::uint64_t ns, int cycles = 1000) {
        for (int i = 0; i < cycles; ++i) histogram.add(Duration(static_cast<std::int64_t>(ns)));
        now_ns += 1'000'000'000;
    }
    [[nodiscard]] LatenessTopic topic() const {
        LatenessTopic t{};
        t.taken_at_ns = now_ns;
        t.total = histogram.total();
        t.max_ns = histogram.max_ns();
        std::copy(histogram.counts().begin(), histogram.counts().end(), t.counts);
        return t;
    }
};

TEST(LatenessWindow, the_whole_run_has_the_metrics_of_the_controller_and_the_minute_its_own) {
    Late late;
    LatenessWindow window;
    EXPECT_TRUE(window.empty());
    late.second(900'000);  // one bad second, long ago
    window.add(late.topic());
    EXPECT_EQ(window.recent_metrics().cycles, 0U);  // no earlier record to compare with
    for (int s = 0; s < 100; ++s) {
        late.second(s == 70 ? 40'000 : 5'000);
        window.add(late.topic());
    }
    EXPECT_EQ(window.whole_metrics().cycles, 101'000U);
    for (const auto& [p, shown] : {std::pair{0.5, window.whole_metrics().p50_ns},
                                   {0.99, window.whole_metrics().p99_ns},
                                   {0.999, window.whole_metrics().p999_ns}})
        EXPECT_EQ(static_cast<std::uint64_t>(shown), late.histogram.percentile_ns(p));
    EXPECT_EQ(window.whole_metrics().max_ns, 900'000);
    EXPECT_NEAR(window.recent_s(), 60.0, 1e-9);
    EXPECT_EQ(window.recent_metrics().cycles, 60'000U);
    EXPECT_NEAR(static_cast<double>(window.recent_metrics().p50_ns), 5'000.0, 400.0);
    EXPECT_NEAR(static_cast<double>(window.recent_metrics().max_ns), 40'000.0, 0.07 * 40'000.0);
}

TEST(LatenessWindow, the_latest_cycle_of_the_minute_is_exact_to_the_nanosecond) {
    Late late;
    LatenessWindow window;
    for (int s = 0; s < 5; ++s) {
        late.second(s == 3 ? 123'457 : 1'000);
        window.add(late.topic());
    }
    EXPECT_EQ(window.recent_metrics().max_ns, 123'457);
}

TEST(LatenessWindow, the_longest_of_a_minute_is_not_understated_beyond_the_range_of_the_histogram) {
    Late late;
    LatenessWindow window;
    late.second(60'000'000'000, 1);  // longest of the run, before the first record
    window.add(late.topic());
    late.second(30'000'000'000, 2);
    window.add(late.topic());
    EXPECT_GE(window.recent_metrics().max_ns, 30'000'000'000);
    EXPECT_GE(window.recent_metrics().p50_ns, 30'000'000'000);
}

TEST(LatenessWindow, another_run_starts_over_and_memory_does_not_grow) {
    Late late;
    LatenessWindow window;
    const std::size_t before = window.memory_bytes();
    for (int s = 0; s < 200; ++s) {
        late.second(2'000, 10);
        window.add(late.topic());
    }
    EXPECT_EQ(window.memory_bytes(), before);
    EXPECT_LT(before, 256U * 1024U);
    Late other;
    other.second(7'000, 3);
    other.now_ns = late.now_ns + 1;
    window.add(other.topic());
    EXPECT_EQ(window.whole_metrics().cycles, 3U);
    EXPECT_EQ(window.recent_metrics().cycles, 0U);
}

TEST(LatenessBars, contain_every_cycle_in_its_bin) {
    Late late;
    late.second(100, 7);
    late.second(60'000, 5);
    late.second(4'000'000'000, 2);
    LatenessWindow window;
    window.add(late.topic());
    const LatenessBars bars(window.whole());
    EXPECT_EQ(bars.count[0], 7U);
    EXPECT_EQ(bars.count[LatenessBars::kBars - 1], 2U);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < LatenessBars::kBars; ++i) {
        sum += bars.count[i];
        if (bars.count[i] == 5) {
            EXPECT_LE(LatenessBars::edge_ns(i), 64'000.0);
            EXPECT_GT(LatenessBars::edge_ns(i + 1), 60'000.0);
        }
    }
    EXPECT_EQ(sum, 14U);
    EXPECT_EQ(bars.most, 7U);
    EXPECT_EQ(bars.last, LatenessBars::kBars - 1);
}

TEST(CounterRate, covers_the_last_second_of_one_run) {
    CounterRate rate;
    EXPECT_FALSE(rate.known());
    for (int i = 0; i < 50; ++i)
        rate.add(100'000'000LL * i, static_cast<std::uint64_t>(i < 25 ? 10 * i : 250 + 100 * (i - 25)));
    EXPECT_NEAR(rate.per_s(), 1000.0, 1e-6);
    rate.add(5'000'000'000, 3);  // another controller
    EXPECT_FALSE(rate.known());
    rate.add(5'100'000'000, 5);
    EXPECT_NEAR(rate.per_s(), 20.0, 1e-6);
    rate.add(5'100'000'000, 5);  // the same record again
    EXPECT_NEAR(rate.per_s(), 20.0, 1e-6);
}

TEST(KnobChanges, consecutive_changes_for_one_reason_are_merged_with_their_reason) {
    KnobChanges log;
    log.add(1.0, 0, 0.8, LevelReason::rate_low);
    log.add(1.1, 1, 0.5, LevelReason::rate_low);
    log.add(1.2, 0, 0.6, LevelReason::rate_low);
    log.add(1.4, 0, 0.4, LevelReason::rate_low);
    log.add(5.0, 0, 0.5, LevelReason::rate_high);
    log.add(5.1, 0, 0.55, LevelReason::rate_high);
    ASSERT_EQ(log.size(), 3U);
    EXPECT_EQ(log.at(0).reason, LevelReason::rate_high);
    EXPECT_FLOAT_EQ(log.at(0).from, 0.4F);
    EXPECT_FLOAT_EQ(log.at(0).to, 0.55F);
    EXPECT_EQ(log.at(2).steps, 3U);
    EXPECT_TRUE(std::isnan(log.at(2).from));  // the previous level is unknown
    EXPECT_EQ(knob_change_text(log.at(0)), "0.40 to 0.55 in 2 steps: force rate above goal");
    EXPECT_EQ(knob_change_text(*log.newest(1)), "to 0.50: force rate below goal");
    EXPECT_EQ(log.in_force(0, 3.0), &log.at(2));
    EXPECT_EQ(log.in_force(0, 0.5), nullptr);
    EXPECT_EQ(log.newest(2), nullptr);
    // A change in the other direction is another change, even for the same reason.
    log.add(5.2, 0, 0.3, LevelReason::rate_high);
    EXPECT_EQ(log.size(), 4U);
}

TEST(KnobChanges, invalid_changes_are_ignored_and_dropped_ones_are_counted) {
    KnobChanges log;
    log.add(std::nan(""), 0, 0.5, LevelReason::hold);
    log.add(1.0, kPathsMax, 0.5, LevelReason::hold);
    log.add(1.0, 0, 1.5, LevelReason::hold);
    log.add(1.0, 0, std::nan(""), LevelReason::hold);
    EXPECT_EQ(log.size(), 0U);
    const std::size_t before = log.memory_bytes();
    for (std::size_t i = 0; i < KnobChanges::kKept + 500; ++i)
        log.add(2.0 * static_cast<double>(i), i % 3, i % 2 == 0 ? 0.2 : 0.7, LevelReason::rate_low);
    EXPECT_EQ(log.size(), KnobChanges::kKept);
    EXPECT_EQ(log.forgotten(), 500U);
    EXPECT_EQ(log.memory_bytes(), before);
    log.add(1.0, 0, 0.9, LevelReason::hold);  // older than the newest of its path
    EXPECT_EQ(log.forgotten(), 500U);
}

}  // namespace
}  // namespace tact::gui_dashboard_test
