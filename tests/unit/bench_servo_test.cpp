// The servo benchmark counts every cycle once, on a plan, and orders its percentiles.
#include <gtest/gtest.h>

#include "tests/bench/bench_servo.hpp"

namespace tact::bench_servo_test {
namespace {

TEST(BenchServo, counts_every_cycle_and_orders_its_percentiles) {
    const ServoBench b = bench_servo({.priority = 0, .seconds = 0.1});
    EXPECT_EQ(b.lateness.cycles, 100U);
    EXPECT_EQ(b.lateness_asleep.cycles, 100U);
    for (const LatenessMetrics& f : {b.lateness, b.lateness_asleep}) {
        EXPECT_GE(f.p50_us, 0.0);
        EXPECT_LE(f.p50_us, f.p99_us);
        EXPECT_LE(f.p99_us, f.p999_us);
        EXPECT_LE(f.p999_us, f.max_us);
    }
    EXPECT_FALSE(b.fifo);
    EXPECT_EQ(b.core, -1);
}

}  // namespace
}  // namespace tact::bench_servo_test
