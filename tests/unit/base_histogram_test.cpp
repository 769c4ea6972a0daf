#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ipc/base/histogram.hpp"

namespace tact::base_histogram_test {
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

TEST(DurationHistogram, the_range_is_that_of_its_buckets) {
    EXPECT_EQ(DurationHistogram::kRangeNs, 8'589'934'592U);  // 2^33 ns
    EXPECT_EQ(DurationHistogram::bucket_of(DurationHistogram::kRangeNs - 1), DurationHistogram::kBuckets - 1);
    // The bucket before the last has an end, and nothing within the range is lost to the last one.
    const std::uint64_t last_begins = DurationHistogram::upper_ns(DurationHistogram::kBuckets - 2) + 1;
    EXPECT_EQ(last_begins, 8'589'934'592U / 32U * 31U);
    EXPECT_EQ(DurationHistogram::bucket_of(last_begins - 1), DurationHistogram::kBuckets - 2);
    EXPECT_EQ(DurationHistogram::bucket_of(last_begins), DurationHistogram::kBuckets - 1);
    EXPECT_EQ(DurationHistogram::bucket_of(~0ULL), DurationHistogram::kBuckets - 1);
}

// p as a fraction, so that the rank of the reference is exact.
struct Part {
    std::uint64_t of, among;
};

// The ceil(p n)-th shortest of the sorted durations, in whole numbers.
std::uint64_t by_sorting(const std::vector<std::uint64_t>& sorted, Part p) {
    const std::uint64_t rank = (p.of * sorted.size() + p.among - 1) / p.among;
    return sorted[std::max<std::uint64_t>(rank, 1) - 1];
}

TEST(DurationHistogram, percentiles_are_at_least_those_of_the_sorted_durations_and_a_bucket_more_at_most) {
    std::mt19937_64 random(20261126);
    // Log-uniform durations up to four times the range: one in fourteen lies beyond it.
    std::uniform_real_distribution<double> octave(0.0, 35.0);
    std::uint64_t beyond = 0;
    for (std::size_t n = 1; n <= 5000; n = n < 130 ? n + 1 : n * 3 / 2) {
        for (int repeat = 0; repeat < 3; ++repeat) {
            DurationHistogram h;
            std::vector<std::uint64_t> all(n);
            for (std::uint64_t& ns : all) {
                ns = static_cast<std::uint64_t>(std::exp2(octave(random)));
                if (ns >= DurationHistogram::kRangeNs) ++beyond;
                h.add(Duration(static_cast<std::int64_t>(ns)));
            }
            std::sort(all.begin(), all.end());
            std::vector<Part> parts{{0, 1}, {1, 2}, {99, 100}, {999, 1000}, {9999, 10000}, {1, 1}};
            for (std::uint64_t k = 1; k < 100; ++k) parts.push_back({k, 100});
            for (std::uint64_t k = 1; k < n; k += 1 + n / 50) parts.push_back({k, n});
            for (const Part p : parts) {
                const std::uint64_t exact = by_sorting(all, p);
                const std::uint64_t said =
                    h.percentile_ns(static_cast<double>(p.of) / static_cast<double>(p.among));
                ASSERT_GE(said, exact) << p.of << " of " << p.among << ", " << n << " durations";
                ASSERT_LE(said, all.back());
                if (exact >= DurationHistogram::upper_ns(DurationHistogram::kBuckets - 2)) continue;
                ASSERT_LE(static_cast<double>(said), 1.0625 * static_cast<double>(exact) + 1.0)
                    << p.of << " of " << p.among << ", " << n << " durations";
            }
            EXPECT_EQ(h.max_ns(), all.back());
        }
    }
    EXPECT_GT(beyond, 100U);
}

TEST(DurationHistogram, what_is_beyond_the_range_is_not_understated_by_counts_from_elsewhere) {
    DurationHistogram h;
    for (int i = 0; i < 10; ++i) h.add(std::chrono::microseconds(20));
    EXPECT_EQ(DurationHistogram::longest_ns(h.counts().data(), 1'000'000U), 20'479U);  // bucket's upper edge
    EXPECT_EQ(DurationHistogram::longest_ns(h.counts().data(), 20'000U), 20'000U);
    h.add(std::chrono::seconds(20));
    EXPECT_EQ(h.percentile_ns(0.95), 20'000'000'000U);
    EXPECT_EQ(DurationHistogram::longest_ns(h.counts().data(), h.max_ns()), 20'000'000'000U);
    EXPECT_EQ(DurationHistogram::longest_ns(DurationHistogram{}.counts().data(), 5U), 0U);
}

TEST(DurationHistogram, hostile_durations_are_counted_at_the_ends) {
    DurationHistogram h;
    h.add(Duration(-5));
    h.add(Duration::max());
    EXPECT_EQ(h.total(), 2U);
    EXPECT_EQ(h.percentile_ns(0.0), 0U);
    EXPECT_EQ(h.percentile_ns(1.0), static_cast<std::uint64_t>(Duration::max().count()));
    EXPECT_EQ(h.percentile_ns(std::nan("")), 0U);
    EXPECT_EQ(h.percentile_ns(7.0), h.max_ns());
}

}  // namespace
}  // namespace tact::base_histogram_test
