// The contract of all safety inputs, emulated or real. A driver's test gives a rig and inherits:
//
//     INSTANTIATE_TEST_SUITE_P(Sim, LinesContract, testing::Values(LinesCase{...}));
//
// The rig controls time: lockstep, or the machine's clock with a thread. Claims wait for
// conditions and do not check durations.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hal/sim/sim_lines.hpp"

namespace tact {

// Safety inputs with all inputs and outputs fitted, whose wiring can be made to fail.
class LinesRig {
public:
    virtual ~LinesRig() = default;
    virtual Lines& lines() = 0;
    virtual void inject(LinesFault fault) = 0;
    virtual std::uint8_t driven() = 0;  // LineOutput at the far end
    virtual Instant elapse(Instant now, Duration d) = 0;
};

struct LinesCase {
    const char* name;
    std::function<std::unique_ptr<LinesRig>()> make;
    int tries = 20'000;  // milliseconds to wait for a condition
};

class LinesContract : public testing::TestWithParam<LinesCase> {
protected:
    LinesContract() : rig_(GetParam().make()) {}

    void open() {
        info_ = rig_->lines().open();
        now_ = Monotonic::now();
    }
    // One millisecond of the servo.
    LinesSample tick() {
        now_ = rig_->elapse(now_, std::chrono::milliseconds(1));
        ++command_.heartbeat;
        rig_->lines().write(command_, now_);
        const LinesSample before = newest_;
        if (rig_->lines().read(newest_, now_)) {
            // Invariants of every sample, whatever the fault.
            const LinesSample& s = newest_;
            EXPECT_GE(s.sequence, before.sequence);
            EXPECT_GE(s.trips, before.trips);
            if (s.state == LinesState::permitted) {
                EXPECT_EQ(s.cause, LinesCause::none);
            }
            if (s.state != LinesState::permitted) {
                EXPECT_EQ(s.outputs & kLineEnable, 0);
            }
            if (s.state == LinesState::permitted && before.state != LinesState::permitted) {
                EXPECT_GT(command_.rearm, rearmed_) << "permitted without a re-arm";
            }
            if (s.state == LinesState::permitted) rearmed_ = command_.rearm;
        }
        return newest_;
    }
    template <class Claim>
    [[nodiscard]] bool until(const Claim& claim) {
        for (int i = 0; i < GetParam().tries; ++i) {
            tick();
            if (claim()) return true;
        }
        return false;
    }
    [[nodiscard]] bool reaches(LinesState state) {
        return until([&] { return newest_.state == state; });
    }
    // Re-arms as a person does, with the amplifier requested on.
    [[nodiscard]] bool permit() {
        if (!reaches(LinesState::waiting)) return false;
        ++command_.rearm;
        command_.enable = true;
        return reaches(LinesState::permitted) && until([&] { return (rig_->driven() & kLineEnable) != 0; }) &&
               until([&] { return (newest_.inputs & kLineAmplifier) != 0; });
    }
    // Samples for more than a hundred milliseconds.
    void dwell() {
        const std::uint64_t from = newest_.sequence;
        ASSERT_TRUE(until([&] { return newest_.sequence > from + 100; }));
    }

    std::unique_ptr<LinesRig> rig_;
    LinesInfo info_;
    LinesCommand command_;
    Instant now_{};
    LinesSample newest_;
    std::uint64_t rearmed_ = 0;
};

struct FaultAndCause {
    LinesFault fault;
    LinesCause cause;
};
inline constexpr FaultAndCause kLinesFaults[] = {
    {LinesFault::stop_pressed, LinesCause::emergency_stop},
    {LinesFault::stop_a_open, LinesCause::channels_disagree},
    {LinesFault::stop_b_open, LinesCause::channels_disagree},
    {LinesFault::pedal_released, LinesCause::dead_man},
    {LinesFault::amplifier_off, LinesCause::amplifier},
    {LinesFault::read_error, LinesCause::lost},
    {LinesFault::unplugged, LinesCause::lost},
};

TEST_P(LinesContract, reports_fitted_inputs_and_outputs) {
    open();
    EXPECT_FALSE(info_.name.empty());
    EXPECT_EQ(info_.inputs, SimBoard::kInputs);
    EXPECT_EQ(info_.outputs, SimBoard::kOutputs);
}

TEST_P(LinesContract, has_no_sample_before_open_and_is_stopped_after) {
    LinesSample s;
    EXPECT_FALSE(rig_->lines().read(s, Monotonic::now()));
    EXPECT_EQ(s.state, LinesState::stopped);
    open();
    EXPECT_EQ(rig_->driven(), 0);
}

TEST_P(LinesContract, closed_contacts_alone_do_not_permit) {
    open();
    command_.enable = true;
    ASSERT_TRUE(reaches(LinesState::waiting));
    dwell();
    EXPECT_EQ(newest_.state, LinesState::waiting);
    EXPECT_EQ(rig_->driven() & kLineEnable, 0);
    EXPECT_TRUE(permit());
}

TEST_P(LinesContract, every_stop_lowers_the_enable_line_until_a_person_re_arms) {
    open();
    for (const FaultAndCause& f : kLinesFaults) {
        SCOPED_TRACE(static_cast<int>(f.fault));
        ASSERT_TRUE(permit());
        const std::uint64_t trips = newest_.trips;
        rig_->inject(f.fault);
        // Checks the count, not the state: where a stop clears itself, a late reader finds the lines waiting already.
        ASSERT_TRUE(until([&] { return newest_.trips > trips; }));
        EXPECT_TRUE(until([&] { return newest_.cause == f.cause; }));
        // A re-arm during the fault is used up.
        ++command_.rearm;
        dwell();
        // A read-back of "off" is correct again as soon as the enable line is low.
        const bool heals = f.fault == LinesFault::amplifier_off;
        EXPECT_EQ(newest_.state, heals ? LinesState::waiting : LinesState::stopped);
        // A disagreement clears only after both channels were open.
        if (f.cause == LinesCause::channels_disagree) {
            rig_->inject(LinesFault::none);
            dwell();
            EXPECT_EQ(newest_.state, LinesState::stopped);
            rig_->inject(LinesFault::stop_pressed);
            EXPECT_TRUE(until([&] { return newest_.cause == LinesCause::emergency_stop; }));
        }
        rig_->inject(LinesFault::none);
        ASSERT_TRUE(reaches(LinesState::waiting));
        dwell();
        EXPECT_EQ(newest_.state, LinesState::waiting);
        EXPECT_EQ(newest_.cause,
                  f.cause == LinesCause::channels_disagree ? LinesCause::emergency_stop : f.cause);
        EXPECT_EQ(rig_->driven() & kLineEnable, 0);
    }
    EXPECT_TRUE(permit());
}

TEST_P(LinesContract, an_amplifier_that_stays_on_stops) {
    open();
    ASSERT_TRUE(permit());
    rig_->inject(LinesFault::amplifier_on);
    dwell();
    EXPECT_EQ(newest_.state, LinesState::permitted);
    command_.enable = false;
    ASSERT_TRUE(reaches(LinesState::stopped));
    EXPECT_EQ(newest_.cause, LinesCause::amplifier);
}

TEST_P(LinesContract, drop_lowers_the_enable_line_until_a_person_re_arms) {
    open();
    ASSERT_TRUE(permit());
    rig_->lines().drop();
    ASSERT_TRUE(until([&] { return (rig_->driven() & kLineEnable) == 0; }));
    ASSERT_TRUE(reaches(LinesState::waiting));
    EXPECT_EQ(newest_.cause, LinesCause::dropped);
    dwell();
    EXPECT_EQ(rig_->driven() & kLineEnable, 0);
    EXPECT_EQ(rig_->lines().health().drops, 1U);
    EXPECT_TRUE(permit());
}

TEST_P(LinesContract, the_watchdog_line_toggles_only_while_the_servo_runs) {
    open();
    const auto toggles = [&] { return rig_->lines().health().toggles; };
    const std::uint64_t before = toggles();
    EXPECT_TRUE(until([&] { return toggles() > before + 20; }));
    // The servo stops: samples continue, toggles do not.
    const auto look = [&] {
        now_ = rig_->elapse(now_, std::chrono::milliseconds(1));
        static_cast<void>(rig_->lines().read(newest_, now_));
        return newest_.sequence;
    };
    const std::uint64_t first = look();
    while (look() < first + 3) {
    }
    const std::uint64_t stood = toggles();
    const int level = rig_->driven() & kLineWatchdog;
    while (look() < first + 50) EXPECT_EQ(rig_->driven() & kLineWatchdog, level);
    EXPECT_EQ(toggles(), stood);
}

TEST_P(LinesContract, the_lamp_follows_its_command) {
    open();
    for (const Lamp lamp : {Lamp::lit, Lamp::dark, Lamp::blinking}) {
        command_.lamp = lamp;
        const auto shows = [&](int level) {
            return until([&] { return (rig_->driven() & kLineLamp) == level; });
        };
        EXPECT_TRUE(lamp == Lamp::dark || shows(kLineLamp));
        EXPECT_TRUE(lamp == Lamp::lit || shows(0));
    }
}

TEST_P(LinesContract, a_replugged_adapter_is_reopened_and_counted) {
    open();
    ASSERT_TRUE(permit());
    rig_->inject(LinesFault::unplugged);
    ASSERT_TRUE(until([&] { return !rig_->lines().health().up; }));
    rig_->inject(LinesFault::none);
    ASSERT_TRUE(until([&] { return rig_->lines().health().up; }));
    const LinesHealth h = rig_->lines().health();
    EXPECT_EQ(h.losses, 1U);
    EXPECT_GE(h.errors, 1U);
    EXPECT_EQ(h.reopened, 1U);
    EXPECT_TRUE(permit());
}

}  // namespace tact
