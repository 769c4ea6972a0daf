// The contract of every head tracker, emulated or real. A tracker's test gives a rig and inherits:
//
//     INSTANTIATE_TEST_SUITE_P(Sim, TrackerContract, testing::Values(TrackerCase{...}));
//
// The rig controls time: lockstep, or the machine's clock with a thread. Claims wait for
// conditions and do not check durations.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hal/sim/sim_tracker.hpp"

namespace tact {

// A tracker with an emulated head, whose bus can be made to fail.
class TrackerRig {
public:
    virtual ~TrackerRig() = default;
    virtual Tracker& tracker() = 0;
    virtual const SimHead& head() = 0;
    virtual void inject(TrackerFault fault) = 0;
    virtual Instant elapse(Instant now, Duration d) = 0;
};

struct TrackerCase {
    const char* name;
    std::function<std::unique_ptr<TrackerRig>()> make;  // with two sensors
    double error_m_max;  // largest pose error against the head; a busy machine's clocks agree badly
    int tries = 20'000;  // milliseconds to wait for a condition
    // The state of the link after these faults, which not every link has.
    TrackerLink bus_off = TrackerLink::bus_off, down = TrackerLink::down;
};

class TrackerContract : public testing::TestWithParam<TrackerCase> {
protected:
    TrackerContract() : rig_(GetParam().make()) {}

    void open() {
        info_ = rig_->tracker().open();
        now_ = rig_->elapse(Monotonic::now(), std::chrono::milliseconds(1));
    }
    void elapse(Duration d) { now_ = rig_->elapse(now_, d); }
    TrackerSample read(unsigned sensor = 0) {
        now_ = rig_->elapse(now_, std::chrono::milliseconds(1));
        const TrackerState state = rig_->tracker().read(sensor, newest_[sensor], now_);
        const TrackerSample& s = newest_[sensor];
        // Invariants of every answer, whatever happens to the bus.
        EXPECT_EQ(state, s.state);
        EXPECT_TRUE(s.T_tracker_sensor.finite());
        EXPECT_NEAR(s.T_tracker_sensor.q.norm(), 1.0, 1e-9);
        EXPECT_LE(to_ns(s.taken_at), to_ns(now_));
        EXPECT_LE(s.T_tracker_sensor.p_m.norm(), 1.6);
        if (s.sequence > 0)
            EXPECT_EQ(state, tracker_state(now_ - s.taken_at));
        else
            EXPECT_EQ(state, TrackerState::lost);
        return s;
    }
    template <class Claim>
    [[nodiscard]] bool until(const Claim& claim) {
        for (int i = 0; i < GetParam().tries; ++i)
            if (claim()) return true;
        return false;
    }
    [[nodiscard]] bool fresh_since(std::uint64_t sequence, unsigned sensor = 0) {
        return until([&] {
            const TrackerSample s = read(sensor);
            return s.state == TrackerState::fresh && s.sequence > sequence;
        });
    }
    // True when samples have stopped and the pose is frozen: nothing new within 100 ms.
    [[nodiscard]] bool stands() {
        return until([&] {
            const TrackerSample before = read();
            elapse(std::chrono::milliseconds(100));
            const TrackerSample s = read();
            if (s.sequence != before.sequence || s.state == TrackerState::fresh) return false;
            EXPECT_EQ(s.T_tracker_sensor.p_m, before.T_tracker_sensor.p_m);
            EXPECT_EQ(s.T_tracker_sensor.q.coeffs(), before.T_tracker_sensor.q.coeffs());
            return true;
        });
    }

    std::unique_ptr<TrackerRig> rig_;
    TrackerInfo info_;
    Instant now_{};
    std::array<TrackerSample, kTrackerSensorsMax + 1> newest_{};
};

TEST_P(TrackerContract, describes_itself) {
    open();
    EXPECT_FALSE(info_.name.empty());
    EXPECT_EQ(info_.sensors, 2U);
    EXPECT_GT(info_.rate_hz, 0.0);
    EXPECT_EQ(rig_->tracker().health().link, TrackerLink::up);
}

TEST_P(TrackerContract, is_lost_before_it_is_opened_and_fresh_after) {
    now_ = Monotonic::now();
    EXPECT_EQ(read().state, TrackerState::lost);
    EXPECT_EQ(rig_->tracker().health().link, TrackerLink::closed);
    open();
    EXPECT_TRUE(fresh_since(0));
}

TEST_P(TrackerContract, samples_increase_in_sequence_and_time_and_match_the_head) {
    open();
    for (const unsigned sensor : {0U, 1U}) {
        TrackerSample before;
        for (int i = 0; i < 50; ++i) {
            ASSERT_TRUE(fresh_since(before.sequence, sensor));
            const TrackerSample& s = newest_[sensor];
            EXPECT_EQ(s.sensor, sensor);
            EXPECT_GT(s.sequence, before.sequence);
            EXPECT_GT(to_ns(s.taken_at), to_ns(before.taken_at));
            EXPECT_LT((s.T_tracker_sensor.p_m - rig_->head().at(sensor, s.taken_at).p_m).norm(),
                      GetParam().error_m_max);
            before = s;
        }
    }
}

TEST_P(TrackerContract, a_missing_sensor_is_lost) {
    open();
    ASSERT_TRUE(fresh_since(0));
    EXPECT_EQ(read(2).state, TrackerState::lost);
    EXPECT_EQ(read(kTrackerSensorsMax).state, TrackerState::lost);
}

TEST_P(TrackerContract, after_any_fault_it_holds_the_last_good_pose_and_recovers_by_itself) {
    open();
    for (const TrackerFault fault :
         {TrackerFault::silent, TrackerFault::corrupt, TrackerFault::not_a_number, TrackerFault::out_of_range,
          TrackerFault::bus_off, TrackerFault::down, TrackerFault::gone}) {
        SCOPED_TRACE(static_cast<int>(fault));
        ASSERT_TRUE(fresh_since(newest_[0].sequence));
        rig_->inject(fault);
        ASSERT_TRUE(stands());
        rig_->inject(TrackerFault::none);
        ASSERT_TRUE(fresh_since(newest_[0].sequence));
    }
}

TEST_P(TrackerContract, is_lost_after_a_second_of_silence) {
    open();
    ASSERT_TRUE(fresh_since(0));
    rig_->inject(TrackerFault::silent);
    EXPECT_TRUE(until([&] { return read().state == TrackerState::lost; }));
}

TEST_P(TrackerContract, refused_frames_are_counted) {
    open();
    for (const TrackerFault fault :
         {TrackerFault::corrupt, TrackerFault::not_a_number, TrackerFault::out_of_range}) {
        ASSERT_TRUE(fresh_since(newest_[0].sequence));
        const std::uint64_t before = rig_->tracker().health().refused;
        rig_->inject(fault);
        EXPECT_TRUE(until([&] { return read(), rig_->tracker().health().refused > before + 10; }));
        rig_->inject(TrackerFault::none);
    }
}

TEST_P(TrackerContract, in_a_flood_the_newest_sample_still_arrives) {
    open();
    ASSERT_TRUE(fresh_since(0));
    rig_->inject(TrackerFault::flood);
    EXPECT_TRUE(until([&] { return read(), rig_->tracker().health().floods > 10; }));
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(fresh_since(newest_[0].sequence));
    rig_->inject(TrackerFault::none);
    EXPECT_TRUE(fresh_since(newest_[0].sequence));
}

TEST_P(TrackerContract, link_losses_are_flagged_counted_and_recovered) {
    open();
    const auto link = [&] { return rig_->tracker().health().link; };
    struct Case {
        TrackerFault fault;
        TrackerLink link;
    };
    std::uint64_t losses = 0;
    for (const Case c :
         {Case{TrackerFault::bus_off, GetParam().bus_off}, Case{TrackerFault::down, GetParam().down},
          Case{TrackerFault::gone, TrackerLink::gone}}) {
        ASSERT_TRUE(fresh_since(newest_[0].sequence));
        rig_->inject(c.fault);
        EXPECT_TRUE(until([&] { return read(), link() == c.link; }));
        EXPECT_GT(rig_->tracker().health().link_losses, losses);
        losses = rig_->tracker().health().link_losses;
        rig_->inject(TrackerFault::none);
        EXPECT_TRUE(until([&] { return read(), link() == TrackerLink::up; }));
    }
    EXPECT_GE(rig_->tracker().health().reopened, 1U);
    EXPECT_GE(rig_->tracker().health().bus_errors, 1U);
}

}  // namespace tact
