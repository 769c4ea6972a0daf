// The reader on a scripted source, and the two clocks; in simulated time.
#include <gtest/gtest.h>

#include <deque>

#include "hal/tracker/can_reader.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact::hal_tracker_reader_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Returns the given frames in order.
class Script final : public CanSource {
public:
    void open() override {}
    bool reopen() noexcept override {
        ++reopens;
        return works;
    }
    CanBatch receive(std::span<CanFrame> into, Duration /*patience*/) noexcept override {
        ++receives;
        CanBatch batch;
        while (batch.count < into.size() && !frames.empty()) {
            into[batch.count++] = frames.front();
            if (!endless) frames.pop_front();
        }
        batch.fault = std::exchange(fault, CanFault::none);
        batch.dropped = std::exchange(dropped, 0U);
        return batch;
    }
    std::deque<CanFrame> frames;
    bool endless = false, works = true;
    CanFault fault = CanFault::none;
    std::uint32_t dropped = 0;
    int reopens = 0, receives = 0;
};

class Reader : public testing::Test {
protected:
    Reader() {
        clock_.advance(seconds(100));
        reader_.opened();
    }
    // One period later, the tracker measures x (m) and sends it.
    void send(double x_m) {
        clock_.advance(microseconds(5000));
        time_us_ += 5000;
        ++counter_;
        source_.frames.push_back(encode(
            PoseFrame{0, counter_, kSensorValid, time_us_, {Vec3(x_m, 0, 0), Quat::Identity()}, 1, 0}));
    }
    void sent(double x_m) {
        send(x_m);
        reader_.round(Duration{0});
    }
    TrackerSample newest() {
        TrackerSample s;
        static_cast<void>(reader_.read(0, s, clock_.now()));
        return s;
    }
    double newest_x() { return newest().T_tracker_sensor.p_m.x(); }
    static CanFrame error(std::uint32_t what) {
        CanFrame f;
        f.kind = CanKind::error;
        f.id = what;
        f.length = 8;
        return f;
    }
    static CanTrackerSettings settings() {
        CanTrackerSettings s;
        s.fix.format = CanFormat::fd;
        s.rate_hz = 200.0;
        s.latency = milliseconds(4);
        return s;
    }

    ManualClock clock_;
    Script source_;
    CanReader reader_{settings(), source_, clock_};
    std::uint8_t counter_ = 0;
    std::uint32_t time_us_ = 0xFFFFF000;  // close to the wrap
};

TEST_F(Reader, a_sample_has_the_time_of_its_measurement) {
    sent(0.1);
    EXPECT_EQ(newest().state, TrackerState::fresh);
    EXPECT_NEAR(newest_x(), 0.1, 26e-6);
    EXPECT_EQ(to_ns(newest().taken_at), to_ns(clock_.now() - milliseconds(4)));
    const Instant first = newest().taken_at;
    send(0.2);
    clock_.advance(milliseconds(7));  // this frame takes longer to arrive
    reader_.round(Duration{0});
    EXPECT_NEAR(newest_x(), 0.2, 26e-6);
    EXPECT_NEAR(to_us(newest().taken_at - first), 5000.0, 10.0);  // the allowed drift
}

TEST_F(Reader, the_state_depends_only_on_the_age) {
    sent(0.1);
    const Instant taken = newest().taken_at;
    TrackerSample s;
    EXPECT_EQ(reader_.read(0, s, taken + milliseconds(50)), TrackerState::fresh);
    EXPECT_EQ(reader_.read(0, s, taken + milliseconds(51)), TrackerState::frozen);
    EXPECT_EQ(reader_.read(0, s, taken + seconds(1)), TrackerState::frozen);
    EXPECT_EQ(reader_.read(0, s, taken + milliseconds(1001)), TrackerState::lost);
    EXPECT_NEAR(s.T_tracker_sensor.p_m.x(), 0.1, 26e-6);  // the pose is kept
    EXPECT_EQ(reader_.read(1, s, taken), TrackerState::lost);
}

TEST_F(Reader, a_flood_takes_a_bounded_round_and_a_pause) {
    send(0.1);
    source_.endless = true;
    const Instant before = clock_.now();
    reader_.round(Duration{0});
    EXPECT_EQ(source_.receives, 4);
    EXPECT_EQ(reader_.health().frames, 4U * kCanBatch);
    EXPECT_EQ(reader_.health().floods, 1U);
    EXPECT_EQ(reader_.health().samples, 1U);
    EXPECT_EQ(reader_.counts().refused[Refusal::repeated], 4U * kCanBatch - 1);
    EXPECT_EQ((clock_.now() - before).count(), CanReader::kFloodPause.count());
}

// After a pause of the thread: a queue of old frames, the newest last.
TEST_F(Reader, old_queued_frames_are_refused_and_the_newest_is_kept) {
    for (int i = 0; i < 20; ++i) sent(0.1);
    for (int i = 0; i < 40; ++i) send(0.001 * i);
    reader_.round(Duration{0});
    EXPECT_NEAR(newest_x(), 0.039, 26e-6);
    EXPECT_EQ(reader_.counts().refused[Refusal::stale], 36U);  // all but those of the last three periods
    EXPECT_EQ(newest().state, TrackerState::fresh);
}

// The first read finds a queue; only its last frame shows how late the first one was.
TEST_F(Reader, a_queue_at_the_start_costs_samples_but_time_never_runs_backwards) {
    for (int i = 1; i <= 5; ++i) send(0.001 * i);
    clock_.advance(milliseconds(2));
    reader_.round(Duration{0});
    TrackerSample before = newest();
    EXPECT_EQ(before.sequence, 1U);
    EXPECT_EQ(reader_.counts().refused[Refusal::stale], 4U);
    clock_.advance(milliseconds(-2));
    for (int i = 6; i < 20; ++i) {
        sent(0.001 * i);
        const TrackerSample s = newest();
        EXPECT_EQ(s.sequence, before.sequence + 1);
        EXPECT_GT(to_ns(s.taken_at), to_ns(before.taken_at));
        before = s;
    }
    EXPECT_EQ(to_ns(before.taken_at), to_ns(clock_.now() - milliseconds(4)));
    EXPECT_NEAR(newest_x(), 0.019, 26e-6);
}

TEST_F(Reader, interface_down_is_flagged_and_the_next_frame_ends_it) {
    sent(0.1);
    source_.fault = CanFault::down;
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.health().link, TrackerLink::down);
    EXPECT_EQ(reader_.health().link_losses, 1U);
    counter_ = static_cast<std::uint8_t>(counter_ + 100);  // frames sent in between are lost
    sent(0.2);
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
    EXPECT_NEAR(newest_x(), 0.2, 26e-6);
    EXPECT_EQ(source_.reopens, 0);
}

TEST_F(Reader, a_lost_interface_is_reopened_twice_a_second_until_it_works) {
    source_.fault = CanFault::gone;
    source_.works = false;
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.health().link, TrackerLink::gone);
    const int received = source_.receives;
    for (int i = 0; i < 200; ++i) {  // two seconds of rounds with the timeout of the thread
        const Instant before = clock_.now();
        reader_.round(milliseconds(10));
        if (clock_.now() == before) clock_.advance(milliseconds(10));
    }
    EXPECT_GE(source_.reopens, 3);
    EXPECT_LE(source_.reopens, 5);
    EXPECT_EQ(source_.receives, received);
    EXPECT_EQ(reader_.health().reopened, 0U);
    source_.works = true;
    clock_.advance(seconds(1));
    sent(0.3);
    EXPECT_EQ(reader_.health().reopened, 1U);
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
    EXPECT_NEAR(newest_x(), 0.3, 26e-6);
}

TEST_F(Reader, bus_off_is_flagged_until_the_controller_restarts) {
    sent(0.1);
    source_.frames.push_back(error(0x40));  // CAN_ERR_BUSOFF
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.health().link, TrackerLink::bus_off);
    EXPECT_EQ(reader_.counts().bus_offs, 1U);
    source_.frames.push_back(error(0x100));  // CAN_ERR_RESTARTED
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
    EXPECT_EQ(reader_.health().bus_errors, 2U);
    CanFrame passive = error(0x04);  // CAN_ERR_CRTL
    passive.data[1] = 0x10;          // receiver is error passive
    source_.frames.push_back(passive);
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.counts().bus_passive, 1U);
    EXPECT_EQ(reader_.health().link, TrackerLink::up);
}

TEST_F(Reader, kernel_drops_are_added_up) {
    source_.dropped = 7;
    reader_.round(Duration{0});
    source_.dropped = 5;
    reader_.round(Duration{0});
    EXPECT_EQ(reader_.health().dropped, 12U);
}

TEST_F(Reader, invalid_settings_are_refused) {
    const auto refused = [this](const auto& change) {
        CanTrackerSettings s = settings();
        change(s);
        EXPECT_THROW(CanReader(s, source_, clock_), StartupError);
    };
    refused([](auto& s) { s.fix.sensors = 0; });
    refused([](auto& s) { s.fix.sensors = 5; });
    refused([](auto& s) { s.rate_hz = 0.0; });
    refused([](auto& s) { s.rate_hz = std::numeric_limits<double>::quiet_NaN(); });
    refused([](auto& s) { s.latency = seconds(1); });
    refused([](auto& s) { s.fix.reach_m = -1.0; });
}

// One hour with a drifting quartz and frames up to 3 ms late: the estimated delay is right within 1 ms.
TEST(TrackerClock, follows_a_drifting_quartz_and_a_counter_that_wraps) {
    for (const double drift : {-100e-6, 0.0, 100e-6}) {
        SeededRandom random(5);
        TrackerClock clock(microseconds(4167));
        double worst_ms = 0.0;
        for (int i = 0; i < 36'000; ++i) {
            const double measured_s = 0.1 * i;
            const auto time_us = static_cast<std::uint32_t>(
                static_cast<std::uint64_t>(std::llround(1e6 * measured_s * (1.0 + drift))) + 0xF0000000U);
            // The first frame and some others arrive without delay, as on a bus that is mostly idle.
            const double delay_s = i % 10 == 0 ? 0.0 : 3e-3 * random.uniform();
            const Instant arrived = instant_from_ns(std::llround(1e9 * (measured_s + delay_s)));
            Instant taken{};
            ASSERT_TRUE(clock.stamp(time_us, arrived, taken)) << i;
            ASSERT_LE(taken, arrived);
            if (i > 100)
                worst_ms = std::max(worst_ms, std::abs(1e3 * (to_s(taken.time_since_epoch()) - measured_s)));
        }
        EXPECT_LT(worst_ms, 1.0) << drift;
        EXPECT_EQ(clock.restarts(), 0U);
    }
}

TEST(TrackerClock, restarts_after_the_tracker_was_power_cycled) {
    TrackerClock clock(milliseconds(5));
    Instant taken{}, now = instant_from_ns(0) + seconds(50);
    ASSERT_TRUE(clock.stamp(7'000'000, now, taken));
    ASSERT_TRUE(clock.stamp(100, now += milliseconds(300), taken));
    EXPECT_EQ(clock.restarts(), 1U);
    EXPECT_EQ(taken, now);
    // A clock set back by a smaller amount: samples are stale at first and accepted after 0.25 s.
    int stale = 0;
    for (std::uint32_t i = 1; i <= 100; ++i)
        stale += clock.stamp(100 + 5000 * i - 500'000, now += milliseconds(5), taken) ? 0 : 1;
    EXPECT_GE(stale, 45);
    EXPECT_LE(stale, 55);
    EXPECT_EQ(clock.restarts(), 2U);
}

}  // namespace
}  // namespace tact::hal_tracker_reader_test
