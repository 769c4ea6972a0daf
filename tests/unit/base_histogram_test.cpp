#include <gtest/gtest.h>

#include "ipc/base/histogram.hpp"

namespace tact {
namespace {

TEST(DurationHistogram, every_duration_lies_in_its_bucket_and_buckets_are_narrow) {
    for (std::uint64_t ns = 0; ns < 4'000'000'000ULL; ns = ns * 17 / 16 + 1) {
        const std::size_t b = DurationHistogram::bucket_of(ns);
        ASSERT_LT(b, DurationHistogram::kBuckets);
        EXPECT_LE(ns, DurationHistogram::upper_ns(b)) << ns;
        if (b > 0) {
            EXPECT_GT(ns, DurationHistogram::upper_ns(b - 1)) << ns;
        }
        EXPECT_LE(static_cast<double>(DurationHistogram::upper_ns(b)), 1.07 * static_cast<double>(ns) + 1.0)
            << ns;
    }
}

TEST(DurationHistogram, percentiles_of_a_known_set_are_never_too_low) {
    DurationHistogram h;
    for (int i = 1; i <= 1000; ++i) h.add(Duration(i * 100));
    EXPECT_GE(h.percentile_ns(0.5), 50'000U);
    EXPECT_LE(h.percentile_ns(0.5), 54'000U);
    EXPECT_GE(h.percentile_ns(0.99), 99'000U);
    EXPECT_EQ(h.percentile_ns(1.0), 100'000U);
    EXPECT_EQ(h.max_ns(), 100'000U);
    EXPECT_EQ(DurationHistogram{}.percentile_ns(0.5), 0U);
}

TEST(DurationHistogram, hostile_durations_are_counted_at_the_ends) {
    DurationHistogram h;
    h.add(Duration(-5));
    h.add(Duration::max());
    EXPECT_EQ(h.total(), 2U);
    EXPECT_EQ(h.percentile_ns(0.0), 0U);
}

}  // namespace
}  // namespace tact
