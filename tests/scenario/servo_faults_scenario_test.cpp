// Faults of the servo loop: zero force within one cycle of detection, latched, reported, and cleared only by a person; and
// conditions that are counted but are no faults.
#include <gtest/gtest.h>

#include "tests/scenario/lockstep.hpp"

namespace tact::servo_faults_scenario_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

ServoSettings strict() {
    ServoSettings s;
    s.governor.law = Law::fixed;  // or the level would fall before the fifth overrun
    s.watchdogs.timing_latches = true;
    s.watchdogs.device_watchdog_latches = true;
    return s;
}

struct Fault {
    const char* name;
    void (*happen)(Lockstep&);
    void (*fix)(Lockstep&);
    RunReason reason;
    int cycles_until_zero;
};

class FaultScenario : public testing::TestWithParam<Fault> {};

TEST_P(FaultScenario, leads_to_zero_force_latched_until_a_person_resets_it) {
    const Fault& f = GetParam();
    Lockstep loop(strict());
    loop.model_.stiffness_n_m = 4.0;  // still far from its rest position when the fault comes
    loop.active();
    ASSERT_EQ(loop.state(), RunState::active);
    ASSERT_GT(loop.shown_n(), 0.05);
    f.happen(loop);
    loop.cycles(f.cycles_until_zero);
    EXPECT_EQ(loop.shown_n(), 0.0);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(loop.reason(), f.reason);
    EXPECT_EQ(loop.said(EventCode::fault_latched), 1);
    FaultSnapshot snapshot{};
    ASSERT_TRUE(loop.mailbox_.fault.read(snapshot));
    EXPECT_EQ(snapshot.reason, static_cast<std::uint64_t>(f.reason));
    EXPECT_EQ(snapshot.cycle, loop.servo_->state().cycle);

    // Arming is refused, and the end of the condition changes nothing.
    f.fix(loop);
    loop.order(CommandKind::arm);
    loop.cycles(50);
    EXPECT_EQ(loop.state(), RunState::fault);
    EXPECT_EQ(loop.health().command_result, static_cast<std::uint32_t>(CommandResult::refused_state));
    EXPECT_EQ(loop.shown_n(), 0.0);
    loop.order(CommandKind::reset_fault);
    loop.cycles(2);
    EXPECT_EQ(loop.state(), RunState::ready);
    EXPECT_EQ(loop.shown_n(), 0.0);
    loop.order(CommandKind::arm);
    loop.cycles(3);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_LT(loop.shown_n(), 0.05);  // the ramp restarts
    loop.cycles(300);
    EXPECT_GT(loop.shown_n(), 0.0);
}

const Fault kFaults[] = {
    {"force_not_a_number", [](Lockstep& l) { l.model_.not_a_number = true; },
     [](Lockstep& l) { l.model_.not_a_number = false; }, RunReason::force_not_finite, 1},
    {"pose_not_a_number", [](Lockstep& l) { l.device_.inject(SimFault::wild_pose); },
     [](Lockstep& l) { l.device_.inject(SimFault::none); }, RunReason::device_fault, 1},
    {"amplifier", [](Lockstep& l) { l.device_.inject(SimFault::amplifier); },
     [](Lockstep& l) { l.device_.inject(SimFault::none); }, RunReason::device_fault, 1},
    {"unplugged", [](Lockstep& l) { l.device_.inject(SimFault::unplugged); },
     [](Lockstep& l) {
         l.device_.inject(SimFault::none);
         static_cast<void>(l.device_.open());
     },
     RunReason::device_lost, 1},
    {"the_devices_own_watchdog_by_itself", [](Lockstep& l) { l.device_.inject(SimFault::watchdog); },
     [](Lockstep& l) { l.device_.inject(SimFault::none); }, RunReason::device_fault, 1},
    {"sample_frozen", [](Lockstep& l) { l.device_.inject(SimFault::frozen); },
     [](Lockstep& l) { l.device_.inject(SimFault::none); }, RunReason::sample_stale, 4},
    {"cycle_six_milliseconds_late", [](Lockstep& l) { l.clock_.advance(milliseconds(7)); }, [](Lockstep&) {},
     RunReason::too_late, 1},
    {"five_overruns_in_a_row",
     [](Lockstep& l) {
         l.model_.clock = &l.clock_;
         l.model_.cost = microseconds(1500);
     },
     [](Lockstep& l) { l.model_.clock = nullptr; }, RunReason::overruns, 6},
    {"one_step_of_seven_milliseconds",
     [](Lockstep& l) {
         l.model_.clock = &l.clock_;
         l.model_.cost = milliseconds(7);
         l.cycles(1);
         l.model_.clock = nullptr;
     },
     [](Lockstep&) {}, RunReason::too_late, 1},
};
INSTANTIATE_TEST_SUITE_P(Servo, FaultScenario, testing::ValuesIn(kFaults),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ServoFaults, the_event_names_the_hand_whose_device_failed) {
    const auto hand_of = [](SimFault fault, bool second, RunReason expected) {
        SpringModel of_second;
        Lockstep loop(strict(), {}, nullptr, nullptr, {.sim = {}, .model = &of_second, .drive = {}});
        loop.active();
        (second ? loop.device2_ : loop.device_).inject(fault);
        loop.cycles(6);
        EXPECT_EQ(loop.reason(), expected);
        RingCursor cursor;
        EventTopic e{};
        while (loop.region_->events.next(cursor, e))
            if (e.code == static_cast<std::uint16_t>(EventCode::fault_latched)) return e.detail;
        return std::uint16_t{99};
    };
    for (const bool second : {false, true}) {
        EXPECT_EQ(hand_of(SimFault::unplugged, second, RunReason::device_lost), second ? 2 : 1);
        EXPECT_EQ(hand_of(SimFault::amplifier, second, RunReason::device_fault), second ? 2 : 1);
        EXPECT_EQ(hand_of(SimFault::frozen, second, RunReason::sample_stale), second ? 2 : 1);
    }
    Lockstep loop(strict());
    loop.active();
    loop.model_.not_a_number = true;
    loop.cycles(1);
    RingCursor cursor;
    EventTopic e{};
    while (loop.region_->events.next(cursor, e) &&
           e.code != static_cast<std::uint16_t>(EventCode::fault_latched)) {
    }
    EXPECT_EQ(e.code, static_cast<std::uint16_t>(EventCode::fault_latched));
    EXPECT_EQ(e.detail, 0U);  // no device
}

TEST(ServoFaults, a_frozen_sample_is_held_for_three_cycles_before_it_is_a_fault) {
    Lockstep loop;
    loop.active();
    loop.device_.inject(SimFault::frozen);
    loop.cycles(3);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_GT(loop.shown_n(), 0.0);
}

TEST(ServoFaults, a_pause_beyond_the_device_watchdog_is_a_fault_or_without_latching_a_new_ramp) {
    for (const bool latches : {true, false}) {
        ServoSettings settings;
        settings.watchdogs.timing_latches = false;
        settings.watchdogs.device_watchdog_latches = latches;
        Lockstep loop(settings);
        loop.model_.stiffness_n_m = 4.0;
        loop.active();
        const double before = loop.shown_n();
        ASSERT_GT(before, 0.05);
        loop.clock_.advance(milliseconds(30));
        loop.cycles(1);
        EXPECT_EQ(loop.shown_n(), 0.0);
        EXPECT_EQ(loop.state(), latches ? RunState::fault : RunState::active);
        if (latches) {
            EXPECT_EQ(loop.reason(), RunReason::device_fault);
            loop.cycles(1000);
            EXPECT_EQ(loop.shown_n(), 0.0);
        } else {
            EXPECT_EQ(loop.said(EventCode::device_watchdog), 1);
            loop.cycles(10);
            EXPECT_EQ(loop.device_.state(), DeviceState::powered);
            EXPECT_LT(loop.shown_n(), 0.1 * before);
            loop.cycles(500);
            EXPECT_GT(loop.shown_n(), 0.02);
        }
    }
}

TEST(ServoFaults, overruns_are_counted_and_skip_forward_without_a_burst) {
    ServoSettings lenient;
    lenient.watchdogs.timing_latches = false;
    lenient.governor.law = Law::fixed;
    Lockstep loop(lenient);
    loop.active();
    const HealthTopic before = loop.health();
    loop.model_.clock = &loop.clock_;
    loop.model_.cost = microseconds(2300);
    const Instant begin = loop.clock_.now();
    loop.cycles(100);
    EXPECT_EQ(loop.clock_.now() - begin, 100 * milliseconds(3) + microseconds(300));
    EXPECT_EQ(loop.servo_->state().pacer.overruns(), 100U);
    EXPECT_EQ(loop.servo_->state().pacer.skipped(), 200U);
    EXPECT_EQ(loop.state(), RunState::active);
    EXPECT_EQ(before.overruns, 0U);
    EXPECT_EQ(before.overrun_at_ns, 0);
    EXPECT_GT(loop.health().overrun_at_ns, to_ns(begin));
    EXPECT_LE(loop.health().overrun_at_ns, loop.health().taken_at_ns);
}

}  // namespace
}  // namespace tact::servo_faults_scenario_test
