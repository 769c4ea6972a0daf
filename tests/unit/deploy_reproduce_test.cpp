// What the reproduction says of a run's samples: means are cycles over time, the worst second is found.
#include "deploy/tact/reproduce_governor.hpp"

#include <gtest/gtest.h>

namespace tact::launch {
namespace {

// Ten samples a second: `slow` cycles per sample within [slow_from_s, slow_to_s), else `fast`.
std::vector<RateSample> samples(double seconds, std::uint64_t fast, std::uint64_t slow, double slow_from_s,
                                double slow_to_s) {
    std::vector<RateSample> all;
    RateSample s;
    for (int i = 0; i <= static_cast<int>(seconds * 10.0 + 0.5); ++i) {
        s.t_s = i * 0.1;
        s.taken_at_ns = 5'000'000'000 + i * 100'000'000LL;
        s.vertices = i % 2 == 0 ? 1000 : 3000;
        s.fps = 20.0;
        s.level_force = i == 7 ? 0.5 : 1.0;
        all.push_back(s);
        s.cycle += s.t_s >= slow_from_s - 1e-9 && s.t_s < slow_to_s - 1e-9 ? slow : fast;
    }
    return all;
}

TEST(GovernorSummary, the_mean_rate_is_cycles_over_time_and_not_the_mean_of_rates) {
    auto some = samples(10.0, 100, 100, 0, 0);
    some.erase(some.begin() + 20, some.begin() + 60);  // a launcher that was held up sees fewer samples
    const RateSummary r = summarize(some, 0.0, 10.0);
    EXPECT_DOUBLE_EQ(r.rate_mean_hz, 1000.0);
    EXPECT_DOUBLE_EQ(r.seconds, 10.0);
    EXPECT_DOUBLE_EQ(r.fps_mean, 20.0);
    EXPECT_DOUBLE_EQ(r.level_force_min, 0.5);
}

TEST(GovernorSummary, the_worst_second_is_found_wherever_it_lies) {
    const RateSummary r = summarize(samples(10.0, 100, 40, 6.3, 7.3), 0.0, 10.0);
    EXPECT_NEAR(r.rate_worst_1s_hz, 400.0, 1e-6);
    EXPECT_NEAR(r.rate_mean_hz, (90 * 100 + 10 * 40) / 10.0, 1e-6);
}

TEST(GovernorSummary, half_a_slow_second_counts_half) {
    EXPECT_NEAR(summarize(samples(10.0, 100, 40, 2.0, 2.5), 0.0, 10.0).rate_worst_1s_hz, 700.0, 1e-6);
}

TEST(GovernorSummary, only_the_samples_within_the_window_count) {
    const RateSummary r = summarize(samples(10.0, 100, 40, 5.0, 10.0), 0.0, 4.95);
    EXPECT_DOUBLE_EQ(r.rate_mean_hz, 1000.0);
    EXPECT_DOUBLE_EQ(r.rate_worst_1s_hz, 1000.0);
}

TEST(GovernorSummary, nothing_measured_gives_nothing) {
    EXPECT_EQ(summarize({}, 0.0, 10.0).seconds, 0.0);
    EXPECT_EQ(summarize(samples(1.0, 100, 100, 0, 0), 5.0, 6.0).rate_mean_hz, 0.0);
}

}  // namespace
}  // namespace tact::launch
