// The logic of the safety inputs, over all pairs of events, in simulated time.
#include "hal/io/line_logic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace tact::hal_line_logic_test {
namespace {

constexpr Duration kMs = std::chrono::milliseconds(1);
constexpr std::uint8_t kAll = kLineStopA | kLineStopB | kLineDeadMan | kLineAmplifier;
constexpr LineLogicSettings kFitted{.fitted = kAll};

// The inputs, a person, and a servo that enables the amplifier whenever it may.
struct Bench {
    explicit Bench(const LineLogicSettings& settings = kFitted) : logic(settings) {}
    void look() {
        now += kMs;
        in.closed =
            static_cast<std::uint8_t>((wiring & ~kLineAmplifier) | (amplifier_on() ? kLineAmplifier : 0));
        logic.look(in, rearms, drops, enabled, now);
        in.touched = 0;
        enabled = logic.state() == LinesState::permitted;
    }
    void looks(int n) {
        for (int i = 0; i < n; ++i) look();
    }
    [[nodiscard]] bool amplifier_on() const { return amplifier == 0 ? enabled : amplifier > 0; }
    void permit() {
        looks(200);
        ++rearms;
        look();
    }

    LineLogic logic;
    LineReading in{.good = true};
    std::uint8_t wiring = kAll;
    int amplifier = 0;  // 0: follows enable; -1: always off; 1: always on
    std::uint64_t rearms = 0, drops = 0;
    bool enabled = false;
    Instant now = instant_from_ns(5'000'000'000);
};

struct Event {
    const char* name;
    void (*happen)(Bench&);
    LinesCause cause;  // none: no stop
    bool lasts;        // until fixed
};
void open(Bench& b, int bits) { b.wiring = static_cast<std::uint8_t>(b.wiring & ~bits); }

constexpr std::array kEvents{
    Event{"nothing", [](Bench&) {}, LinesCause::none, false},
    Event{"stop pressed", [](Bench& b) { open(b, kLineStopA | kLineStopB); }, LinesCause::emergency_stop,
          true},
    Event{"channel a opens", [](Bench& b) { open(b, kLineStopA); }, LinesCause::emergency_stop, true},
    Event{"channel b opens", [](Bench& b) { open(b, kLineStopB); }, LinesCause::emergency_stop, true},
    Event{"channel a bounces", [](Bench& b) { b.in.touched |= kLineStopA; }, LinesCause::emergency_stop,
          false},
    Event{"pedal released", [](Bench& b) { open(b, kLineDeadMan); }, LinesCause::dead_man, true},
    Event{"pedal bounces", [](Bench& b) { b.in.touched |= kLineDeadMan; }, LinesCause::dead_man, false},
    Event{"adapter lost", [](Bench& b) { b.in.good = false; }, LinesCause::lost, true},
    Event{"dropped", [](Bench& b) { ++b.drops; }, LinesCause::dropped, false},
    Event{"re-armed", [](Bench& b) { ++b.rearms; }, LinesCause::none, false},
};

void fix(Bench& b) {
    open(b, kLineStopA | kLineStopB);  // as a person who presses and releases the button
    b.in.good = true;
    b.amplifier = 0;
    b.looks(50);
    b.wiring = kAll;
}

TEST(LineLogic, every_pair_of_events_stops_at_once_and_only_a_re_arm_permits_again) {
    for (const Event& a : kEvents) {
        for (const Event& b : kEvents) {
            for (const int between : {0, 1, 10, 29, 30, 31, 60}) {
                SCOPED_TRACE(std::string(a.name) + ", after " + std::to_string(between) + " looks " + b.name);
                Bench bench;
                bench.permit();
                ASSERT_EQ(bench.logic.state(), LinesState::permitted);
                const std::uint64_t trips = bench.logic.trips();
                a.happen(bench);
                if (between > 0) bench.look();
                if (between > 0 && a.cause != LinesCause::none) {
                    EXPECT_EQ(bench.logic.state(), LinesState::stopped);
                    EXPECT_EQ(bench.logic.cause(), a.cause);
                }
                bench.looks(between - 1);
                b.happen(bench);
                bench.look();
                const bool stops = a.cause != LinesCause::none || b.cause != LinesCause::none;
                // A re-arm is accepted after a stop that has ended long enough ago.
                const bool again = b.cause == LinesCause::none && b.name == std::string("re-armed") &&
                                   !a.lasts && between >= 32;
                if (!stops) {
                    EXPECT_EQ(bench.logic.state(), LinesState::permitted);
                    EXPECT_EQ(bench.logic.trips(), trips);
                    continue;
                }
                EXPECT_GT(bench.logic.trips(), trips);
                if (again) {
                    EXPECT_EQ(bench.logic.state(), LinesState::permitted);
                    continue;
                }
                EXPECT_NE(bench.logic.state(), LinesState::permitted);
                if (b.cause != LinesCause::none) {
                    EXPECT_EQ(bench.logic.state(), LinesState::stopped);
                }
                fix(bench);
                bench.looks(500);
                EXPECT_EQ(bench.logic.state(), LinesState::waiting);
                ++bench.rearms;
                bench.look();
                EXPECT_EQ(bench.logic.state(), LinesState::permitted);
            }
        }
    }
}

TEST(LineLogic, of_two_simultaneous_events_the_more_severe_is_the_cause) {
    for (const Event& a : kEvents) {
        for (const Event& b : kEvents) {
            if (a.cause == LinesCause::none || b.cause == LinesCause::none) continue;
            Bench bench;
            bench.permit();
            a.happen(bench);
            b.happen(bench);
            bench.look();
            EXPECT_EQ(bench.logic.cause(), std::min(a.cause, b.cause)) << a.name << ", " << b.name;
        }
    }
}

TEST(LineLogic, contacts_must_stay_closed_for_the_release_time) {
    Bench bench;
    bench.permit();
    open(bench, kLineDeadMan);
    bench.look();
    bench.wiring = kAll;
    for (int i = 0; i < 10; ++i) {  // a pedal that bounces every 25 ms
        bench.looks(25);
        EXPECT_EQ(bench.logic.state(), LinesState::stopped);
        bench.in.touched = kLineDeadMan;
        bench.look();
    }
    bench.looks(30);
    EXPECT_EQ(bench.logic.state(), LinesState::stopped);
    bench.look();  // 30 ms after the first good sample
    EXPECT_EQ(bench.logic.state(), LinesState::waiting);
}

TEST(LineLogic, a_re_arm_during_a_stop_has_no_effect) {
    Bench bench;
    bench.permit();
    open(bench, kLineDeadMan);
    bench.looks(10);
    ++bench.rearms;
    bench.looks(10);
    bench.wiring = kAll;
    bench.looks(5);
    ++bench.rearms;  // within the release time
    bench.looks(500);
    EXPECT_EQ(bench.logic.state(), LinesState::waiting);
}

TEST(LineLogic, disagreeing_channels_are_accepted_only_after_both_were_open) {
    for (const int open_first : {int{kLineStopA}, int{kLineStopB}}) {
        Bench bench;
        bench.permit();
        open(bench, open_first);
        bench.looks(21);  // the first sample starts the time; 20 ms are allowed
        EXPECT_EQ(bench.logic.cause(), LinesCause::emergency_stop);
        bench.look();
        EXPECT_EQ(bench.logic.cause(), LinesCause::channels_disagree);
        bench.wiring = kAll;
        bench.looks(500);
        EXPECT_EQ(bench.logic.state(), LinesState::stopped);
        EXPECT_EQ(bench.logic.cause(), LinesCause::channels_disagree);
        open(bench, kLineStopA | kLineStopB);
        bench.looks(2);
        EXPECT_EQ(bench.logic.cause(), LinesCause::emergency_stop);
        bench.wiring = kAll;
        bench.looks(100);
        EXPECT_EQ(bench.logic.state(), LinesState::waiting);
    }
}

TEST(LineLogic, channels_that_open_in_sequence_within_the_time_are_an_ordinary_stop) {
    Bench bench;
    bench.permit();
    open(bench, kLineStopA);
    bench.looks(15);
    open(bench, kLineStopB);
    bench.looks(300);
    EXPECT_EQ(bench.logic.cause(), LinesCause::emergency_stop);
    bench.wiring = kAll & ~kLineStopA;
    bench.looks(15);
    bench.wiring = kAll;
    bench.looks(100);
    EXPECT_EQ(bench.logic.state(), LinesState::waiting);
}

TEST(LineLogic, an_amplifier_that_does_not_follow_enable_stops_after_its_time) {
    Bench off;
    off.permit();
    off.looks(10);
    off.amplifier = -1;
    off.looks(101);
    EXPECT_EQ(off.logic.state(), LinesState::permitted);
    off.look();
    EXPECT_EQ(off.logic.cause(), LinesCause::amplifier);
    Bench on;
    on.looks(200);
    on.amplifier = 1;  // without enable: a welded relay
    on.looks(102);
    EXPECT_EQ(on.logic.state(), LinesState::stopped);
    EXPECT_EQ(on.logic.cause(), LinesCause::amplifier);
}

TEST(LineLogic, inputs_that_are_not_fitted_stop_nothing) {
    Bench bench({.fitted = kLineStopA});
    bench.wiring = kLineStopA;
    bench.permit();
    EXPECT_EQ(bench.logic.state(), LinesState::permitted);
    bench.looks(500);
    EXPECT_EQ(bench.logic.state(), LinesState::permitted);
    bench.wiring = 0;
    bench.look();
    EXPECT_EQ(bench.logic.cause(), LinesCause::emergency_stop);
    bench.wiring = kLineStopA;
    bench.looks(40);
    EXPECT_EQ(bench.logic.state(), LinesState::waiting);
}

}  // namespace
}  // namespace tact::hal_line_logic_test
