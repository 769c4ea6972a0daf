// The whole loop with emulated safety inputs, in lockstep: zero force in the cycle that detects a stop, latched with its
// cause, cleared only by a person.
#include <gtest/gtest.h>

#include "hal/sim/sim_lines.hpp"
#include "tests/scenario/lockstep.hpp"

namespace tact::lines_scenario_test {
namespace {

using std::chrono::milliseconds;

// The lines are open before the loop is built.
struct WithLines {
    WithLines() { static_cast<void>(lines_.open()); }
    SimLines lines_;
};

struct Loop : WithLines, Lockstep {
    Loop() : Lockstep({}, {}, &lines_) {
        model_.stiffness_n_m = 4.0;  // still far from its rest position when the stop comes
        cycles(60);                  // contacts have settled
    }
    [[nodiscard]] std::uint8_t driven() { return lines_.board().driven(); }
    [[nodiscard]] bool enabled() { return (driven() & kLineEnable) != 0; }
    [[nodiscard]] CommandResult result() const { return static_cast<CommandResult>(health().command_result); }
};

struct Stop {
    const char* name;
    LinesFault fault;
    RunReason reason;
    int cycles_until_zero;  // 1: the cycle that detects it
};

class LinesScenario : public testing::TestWithParam<Stop> {};

TEST_P(LinesScenario, leads_to_zero_force_latched_until_a_person_resets_and_arms) {
    const Stop& stop = GetParam();
    Loop loop;
    loop.active();
    ASSERT_EQ(loop.state(), RunState::active);
    ASSERT_GT(loop.shown_n(), 0.05);
    ASSERT_TRUE(loop.enabled());
    loop.lines_.inject(stop.fault);
    loop.cycles(stop.cycles_until_zero - 1);
    EXPECT_GT(loop.shown_n(), 0.0);
    loop.cycles(1);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(loop.reason(), stop.reason);
    EXPECT_EQ(loop.said(EventCode::fault_latched), 1);
    if (stop.fault != LinesFault::unplugged) {
        EXPECT_FALSE(loop.enabled());
    }

    // An active stop cannot be reset.
    if (stop.fault != LinesFault::pedal_released && stop.fault != LinesFault::amplifier_off) {
        loop.cycles(100);
        loop.order(CommandKind::reset_fault);
        loop.cycles(2);
        EXPECT_EQ(loop.state(), RunState::fault);
    }
    // Releasing it alone has no effect.
    loop.lines_.inject(LinesFault::stop_pressed);
    loop.cycles(1000);
    loop.lines_.inject(LinesFault::none);
    loop.cycles(1000);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(loop.reason(), stop.reason);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_FALSE(loop.enabled());
    loop.order(CommandKind::arm);
    loop.cycles(5);
    EXPECT_EQ(loop.result(), CommandResult::refused_state);
    loop.order(CommandKind::reset_fault);
    loop.cycles(100);
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_FALSE(loop.enabled());
    EXPECT_EQ(loop.shown_n(), 0.0);
    loop.order(CommandKind::arm);
    loop.cycles(3);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_TRUE(loop.enabled());
    EXPECT_LT(loop.shown_n(), 0.05);  // the ramp restarts
    loop.cycles(300);
    EXPECT_GT(loop.shown_n(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Servo, LinesScenario,
    testing::Values(Stop{"emergency_stop", LinesFault::stop_pressed, RunReason::emergency_stop, 1},
                    Stop{"one_channel", LinesFault::stop_a_open, RunReason::emergency_stop, 1},
                    Stop{"the_other_channel", LinesFault::stop_b_open, RunReason::emergency_stop, 1},
                    Stop{"pedal", LinesFault::pedal_released, RunReason::dead_man, 1},
                    Stop{"read_error", LinesFault::read_error, RunReason::lines_lost, 1},
                    Stop{"unplugged", LinesFault::unplugged, RunReason::lines_lost, 1},
                    // 100 ms to follow, counted from the first differing sample
                    Stop{"amplifier_off", LinesFault::amplifier_off, RunReason::amplifier_readback, 102}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(LinesScenarios, an_emergency_stop_is_a_fault_even_unpowered_and_a_released_pedal_is_not) {
    Loop loop;
    loop.lines_.inject(LinesFault::pedal_released);
    loop.cycles(100);
    EXPECT_EQ(loop.state(), RunState::ready);
    loop.order(CommandKind::arm);
    loop.cycles(2);
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_EQ(loop.result(), CommandResult::refused_state);
    EXPECT_EQ(loop.health().lines, static_cast<std::uint8_t>(LinesShown::stopped));
    EXPECT_EQ(loop.health().lines_reason, static_cast<std::uint8_t>(RunReason::dead_man));
    // A released pedal masks no other fault.
    loop.device_.inject(SimFault::unplugged);
    loop.cycles(2);
    EXPECT_EQ(loop.reason(), RunReason::device_lost);

    Loop other;
    other.lines_.inject(LinesFault::stop_pressed);
    other.cycles(1);
    EXPECT_EQ(other.state(), RunState::fault);
    EXPECT_EQ(other.reason(), RunReason::emergency_stop);
}

TEST(LinesScenarios, after_a_pedal_fault_reset_and_arm_suffice) {
    Loop loop;
    loop.lines_.inject(LinesFault::pedal_released);
    loop.cycles(100);
    loop.lines_.inject(LinesFault::none);
    loop.cycles(10);
    loop.order(CommandKind::arm);  // within the release time
    loop.cycles(2);
    EXPECT_EQ(loop.state(), RunState::ready);
    loop.cycles(40);
    loop.order(CommandKind::arm);
    loop.cycles(3);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_TRUE(loop.enabled());
}

TEST(LinesScenarios, a_brief_stop_while_the_servo_was_stopped_is_latched) {
    Loop loop;
    loop.active();
    // The pump continues while the servo is stopped.
    LinesSample s;
    Instant now = loop.clock_.now();
    loop.lines_.inject(LinesFault::stop_pressed);
    for (int i = 0; i < 100; ++i) {
        now += milliseconds(1);
        if (i == 20) loop.lines_.inject(LinesFault::none);
        static_cast<void>(loop.lines_.read(s, now));
    }
    ASSERT_EQ(s.state, LinesState::waiting);
    loop.clock_.advance(milliseconds(100));
    loop.cycles(1);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.reason(), RunReason::emergency_stop);
}

TEST(LinesScenarios, a_drop_by_the_supervisor_is_a_fault_of_its_own) {
    Loop loop;
    loop.active();
    loop.lines_.drop();
    loop.mailbox_.pulse.drops.fetch_add(1);
    loop.cycles(1);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(loop.reason(), RunReason::supervisor);
    loop.cycles(1000);
    EXPECT_FALSE(loop.enabled());
    loop.order(CommandKind::reset_fault);
    loop.cycles(5);
    loop.order(CommandKind::arm);
    loop.cycles(5);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_TRUE(loop.enabled());
}

TEST(LinesScenarios, the_enable_line_is_high_only_with_the_amplifier_and_the_lamp_shows_it) {
    Loop loop;
    EXPECT_FALSE(loop.enabled());
    EXPECT_EQ(loop.driven() & kLineLamp, 0);
    loop.active();
    EXPECT_TRUE(loop.enabled());
    EXPECT_NE(loop.driven() & kLineLamp, 0);
    loop.order(CommandKind::disarm);
    loop.cycles(200);
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_FALSE(loop.enabled());
    EXPECT_EQ(loop.driven() & kLineLamp, 0);
    loop.active();
    loop.mailbox_.stop_signal.store(15);
    loop.cycles(300);
    EXPECT_TRUE(loop.servo_->finished());
    LinesSample s;
    static_cast<void>(loop.lines_.read(s, loop.clock_.now() + milliseconds(1)));
    EXPECT_FALSE(loop.enabled());
}

TEST(LinesScenarios, the_watchdog_line_toggles_once_per_cycle) {
    Loop loop;
    const std::uint64_t before = loop.lines_.health().toggles;
    loop.cycles(100);
    EXPECT_EQ(loop.lines_.health().toggles, before + 100);
}

}  // namespace
}  // namespace tact::lines_scenario_test
