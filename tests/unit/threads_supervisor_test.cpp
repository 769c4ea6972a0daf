// The supervisor: as a function of what it sees, and once as a thread.
#include "rt/threads/supervisor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"

namespace tact {
namespace {

constexpr Duration kMs = std::chrono::milliseconds(1);
const Instant kBegin = instant_from_ns(7'000'000'000);

TEST(Supervision, drops_in_the_first_look_at_a_heartbeat_older_than_its_limit) {
    Supervision s(5 * kMs);
    for (int age_ms = 0; age_ms <= 5; ++age_ms) EXPECT_FALSE(s.check(kBegin, true, 0, kBegin + age_ms * kMs));
    EXPECT_TRUE(s.check(kBegin, true, 0, kBegin + 6 * kMs));
    EXPECT_TRUE(s.dropped());
    EXPECT_EQ(s.drops(), 1U);
}

TEST(Supervision,
     whatever_the_phase_of_its_looks_a_servo_that_stands_is_dropped_within_the_limit_and_a_look) {
    for (int phase_us = 0; phase_us < 1000; phase_us += 37) {
        Supervision s(5 * kMs);
        Instant now = kBegin + std::chrono::microseconds(phase_us);
        while (!s.check(kBegin, true, 0, now)) now += Supervisor::kEvery;
        EXPECT_LE(to_ns(now) - to_ns(kBegin), to_ns(instant_from_ns(0) + 5 * kMs + Supervisor::kEvery));
        EXPECT_GT(now - kBegin, 5 * kMs);
    }
}

TEST(Supervision, a_servo_that_beats_or_that_powers_nothing_is_left_alone) {
    Supervision s(5 * kMs);
    Instant now = kBegin;
    for (int i = 0; i < 1000; ++i) {
        now += kMs;
        EXPECT_FALSE(s.check(now - (i % 5) * kMs, true, 0, now));
        EXPECT_FALSE(s.check(kBegin - std::chrono::seconds(1), false, 0, now));
        EXPECT_FALSE(s.check(now + kMs, true, 0, now));  // the beat came after the look at the clock
    }
    EXPECT_EQ(s.drops(), 0U);
}

TEST(Supervision, a_drop_stays_until_a_person_re_arms_however_well_the_servo_beats) {
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

TEST(Supervisor, its_thread_drops_once_when_the_servo_stands_and_again_after_a_re_arm) {
    ServoPulse pulse;
    std::atomic<int> calls{0};
    Supervisor supervisor(pulse, 5 * kMs, [&calls] { ++calls; });
    supervisor.start(gettid());
    const auto wait_for = [&](std::uint64_t drops) {
        for (int i = 0; i < 60'000 && pulse.drops.load() < drops; ++i) usleep(1000);
        return pulse.drops.load() == drops;
    };
    // Nothing is powered: the beat of long ago is none of its business.
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
}  // namespace tact
