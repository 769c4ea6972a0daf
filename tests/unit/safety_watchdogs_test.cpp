// The watchdogs: counts, warnings and trips.
#include "rt/safety/watchdogs.hpp"

#include <gtest/gtest.h>

namespace tact::safety_watchdogs_test {
namespace {

using std::chrono::microseconds;

WatchdogInput fine(std::int64_t now_ns = 1'000'000'000) {
    return {.now = instant_from_ns(now_ns), .sample_taken_at = instant_from_ns(now_ns)};
}

TEST(Watchdogs, one_overrun_counts_three_warn_and_five_trip) {
    Watchdogs dogs;
    WatchdogInput late = fine();
    late.overran = true;
    for (int i = 1; i <= 4; ++i) {
        EXPECT_EQ(dogs.check(late).reason, RunReason::none) << i;
        EXPECT_EQ(dogs.overruns_in_a_row(), static_cast<std::uint32_t>(i));
        EXPECT_EQ(dogs.warns(), i == 3);
    }
    const Trip trip = dogs.check(late);
    EXPECT_EQ(trip.reason, RunReason::overruns);
    EXPECT_DOUBLE_EQ(trip.measured, 5.0);
}

TEST(Watchdogs, the_safety_inputs_trip_and_a_released_pedal_masks_no_other_fault) {
    Watchdogs dogs;
    for (const RunReason reason : {RunReason::emergency_stop, RunReason::stop_channels,
                                   RunReason::amplifier_readback, RunReason::lines_lost}) {
        WatchdogInput in = fine();
        in.lines = reason;
        in.lines_age = microseconds(700);
        in.device_lost = true;  // the inputs come first
        EXPECT_EQ(dogs.check(in).reason, reason);
        EXPECT_DOUBLE_EQ(dogs.check(in).measured, 700.0);
    }
    for (const RunReason reason : {RunReason::dead_man, RunReason::supervisor}) {
        WatchdogInput in = fine();
        in.lines = reason;
        EXPECT_EQ(dogs.check(in).reason, reason);
        in.sample_taken_at = in.now - microseconds(4000);
        EXPECT_EQ(dogs.check(in).reason, RunReason::sample_stale);
        in.force_finite = false;
        EXPECT_EQ(dogs.check(in).reason, RunReason::force_not_finite);
        in.device_lost = true;
        EXPECT_EQ(dogs.check(in).reason, RunReason::device_lost);
    }
    WatchdogInput in = fine();
    in.supervisor = true;
    EXPECT_EQ(dogs.check(in).reason, RunReason::supervisor);
}

TEST(Watchdogs, a_good_cycle_restarts_the_count) {
    Watchdogs dogs;
    WatchdogInput late = fine();
    late.overran = true;
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(dogs.check(i % 5 == 4 ? fine() : late).reason, RunReason::none);
    }
}

TEST(Watchdogs, lateness_above_five_milliseconds_trips) {
    Watchdogs dogs;
    WatchdogInput in = fine();
    in.lateness = microseconds(5000);
    EXPECT_EQ(dogs.check(in).reason, RunReason::none);
    in.lateness = microseconds(5001);
    EXPECT_EQ(dogs.check(in).reason, RunReason::too_late);
}

TEST(Watchdogs, without_latching_lateness_is_still_counted) {
    WatchdogSettings settings;
    settings.timing_latches = false;
    Watchdogs dogs(settings);
    WatchdogInput in = fine();
    in.lateness = std::chrono::seconds(1);
    in.overran = true;
    for (int i = 0; i < 50; ++i) EXPECT_EQ(dogs.check(in).reason, RunReason::none);
    EXPECT_EQ(dogs.overruns_in_a_row(), 50U);
}

TEST(Watchdogs, a_sample_is_held_for_three_cycles_and_trips_at_the_fourth) {
    Watchdogs dogs;
    WatchdogInput in = fine();
    for (int cycles = 1; cycles <= 4; ++cycles) {
        in.now += microseconds(1000);
        EXPECT_EQ(dogs.check(in).reason, cycles <= 3 ? RunReason::none : RunReason::sample_stale);
    }
}

TEST(Watchdogs, a_lost_device_is_reported_before_its_consequences) {
    Watchdogs dogs;
    WatchdogInput in = fine();
    in.device_lost = in.device_fault = true;
    in.force_finite = false;
    in.now += std::chrono::seconds(1);
    EXPECT_EQ(dogs.check(in).reason, RunReason::device_lost);
    in.device_lost = false;
    EXPECT_EQ(dogs.check(in).reason, RunReason::device_fault);
    in.device_fault = false;
    EXPECT_EQ(dogs.check(in).reason, RunReason::force_not_finite);
}

}  // namespace
}  // namespace tact::safety_watchdogs_test
