// The supervisor: its decision as a function, and once as a thread.
#include "rt/threads/supervisor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"

namespace tact::threads_supervisor_test {
namespace {

constexpr Duration kMs = std::chrono::milliseconds(1);
const Instant kBegin = instant_from_ns(7'000'000'000);

TEST(Supervision, drops_at_the_first_check_with_a_heartbeat_older_than_its_limit) {
    Supervision s(5 * kMs);
    for (int age_ms = 0; age_ms <= 5; ++age_ms) EXPECT_FALSE(s.check(kBegin, true, 0, kBegin + age_ms * kMs));
    EXPECT_TRUE(s.check(kBegin, true, 0, kBegin + 6 * kMs));
    EXPECT_TRUE(s.dropped());
    EXPECT_EQ(s.drops(), 1U);
}

TEST(Supervision, a_stopped_servo_is_dropped_within_the_limit_plus_one_check_at_any_phase) {
    for (int phase_us = 0; phase_us < 1000; phase_us += 37) {
        Supervision s(5 * kMs);
        Instant now = kBegin + std::chrono::microseconds(phase_us);
        while (!s.check(kBegin, true, 0, now)) now += Supervisor::kEvery;
        EXPECT_LE(to_ns(now) - to_ns(kBegin), to_ns(instant_from_ns(0) + 5 * kMs + Supervisor::kEvery));
        EXPECT_GT(now - kBegin, 5 * kMs);
    }
}

TEST(Supervision, a_servo_with_a_heartbeat_or_without_power_is_not_dropped) {
    Supervision s(5 * kMs);
    Instant now = kBegin;
    for (int i = 0; i < 1000; ++i) {
        now += kMs;
        EXPECT_FALSE(s.check(now - (i % 5) * kMs, true, 0, now));
        EXPECT_FALSE(s.check(kBegin - std::chrono::seconds(1), false, 0, now));
        EXPECT_FALSE(s.check(now + kMs, true, 0, now));  // the beat came after the clock was read
    }
    EXPECT_EQ(s.drops(), 0U);
}

TEST(Supervision, a_drop_persists_until_a_person_re_arms_despite_heartbeats) {
    Supervision s(5 * kMs);
    ASSERT_TRUE(s.check(kBegin, true, 3, kBegin + 6 * kMs));
    Instant now = kBegin + 6 * kMs;
    for (int i = 0; i < 100; ++i) {
        now += kMs;
        EXPECT_FALSE(s.check(now, true, 3, now));
        EXPECT_TRUE(s.dropped());
    }
    EXPECT_FALSE(s.check(now, false, 4, now));
    EXPECT_FALSE(s.dropped());
    EXPECT_TRUE(s.check(now, true, 4, now + 6 * kMs));
    EXPECT_EQ(s.drops(), 2U);
}

TEST(Supervisor, its_thread_drops_once_when_the_servo_stops_and_again_after_a_re_arm) {
    ServoPulse pulse;
    std::atomic<int> calls{0};
    Supervisor supervisor(pulse, 5 * kMs, [&calls] { ++calls; });
    supervisor.start(gettid());
    const auto wait_for = [&](std::uint64_t drops) {
        for (int i = 0; i < 60'000 && pulse.drops.load() < drops; ++i) usleep(1000);
        return pulse.drops.load() == drops;
    };
    // Nothing is powered: the supervisor ignores the old beat.
    usleep(20'000);
    EXPECT_EQ(calls.load(), 0);
    pulse.beat_ns.store(to_ns(Monotonic::now()));
    pulse.enabled.store(true);
    EXPECT_TRUE(wait_for(1));
    EXPECT_EQ(calls.load(), 1);
    pulse.enabled.store(false);
    pulse.rearms.store(1);
    usleep(20'000);
    EXPECT_EQ(calls.load(), 1);
    pulse.beat_ns.store(to_ns(Monotonic::now()));
    pulse.enabled.store(true);
    EXPECT_TRUE(wait_for(2));
    EXPECT_EQ(calls.load(), 2);
}

}  // namespace
}  // namespace tact::threads_supervisor_test
