// The state machine over all states and all pairs of events, in simulated time.
#include "rt/safety/state_machine.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace tact::safety_state_machine_test {
namespace {

constexpr std::array kStates{RunState::off, RunState::ready, RunState::armed, RunState::active,
                             RunState::fault};

struct Named {
    const char* name;
    void (*set)(RunEvents&);
};

// All events; trips by cause.
constexpr std::array kEvents{
    Named{"nothing", [](RunEvents&) {}},
    Named{"open", [](RunEvents& e) { e.open = true; }},
    Named{"close", [](RunEvents& e) { e.close = true; }},
    Named{"stop", [](RunEvents& e) { e.stop = true; }},
    Named{"arm", [](RunEvents& e) { e.arm = true; }},
    Named{"disarm", [](RunEvents& e) { e.disarm = true; }},
    Named{"reset", [](RunEvents& e) { e.reset = true; }},
    Named{"hand", [](RunEvents& e) { e.hand_present = true; }},
    Named{"gui silent", [](RunEvents& e) { e.gui_silent = true; }},
    Named{"lost", [](RunEvents& e) { e.trip = RunReason::device_lost; }},
    Named{"device fault", [](RunEvents& e) { e.trip = RunReason::device_fault; }},
    Named{"stale", [](RunEvents& e) { e.trip = RunReason::sample_stale; }},
    Named{"not finite", [](RunEvents& e) { e.trip = RunReason::force_not_finite; }},
    Named{"overruns", [](RunEvents& e) { e.trip = RunReason::overruns; }},
    Named{"late", [](RunEvents& e) { e.trip = RunReason::too_late; }},
    Named{"model", [](RunEvents& e) { e.trip = RunReason::model_failed; }},
    Named{"barred", [](RunEvents& e) { e.arm_barred = true; }},
    Named{"emergency stop", [](RunEvents& e) { e.trip = RunReason::emergency_stop; }},
    Named{"stop channels", [](RunEvents& e) { e.trip = RunReason::stop_channels; }},
    Named{"dead-man", [](RunEvents& e) { e.trip = RunReason::dead_man; }},
    Named{"read-back", [](RunEvents& e) { e.trip = RunReason::amplifier_readback; }},
    Named{"lines lost", [](RunEvents& e) { e.trip = RunReason::lines_lost; }},
    Named{"supervisor", [](RunEvents& e) { e.trip = RunReason::supervisor; }},
};

RunStatus in(RunState state) { return {state, RunReason::none, instant_from_ns(1)}; }

// Checks the rules for one transition; returns the broken rule, or nothing.
std::string broken_rule(const RunStatus& from, const RunEvents& e, const RunStatus& to) {
    const bool device_trip = e.trip == RunReason::device_lost || e.trip == RunReason::device_fault ||
                             e.trip == RunReason::sample_stale || e.trip == RunReason::emergency_stop ||
                             e.trip == RunReason::stop_channels || e.trip == RunReason::amplifier_readback ||
                             e.trip == RunReason::lines_lost;
    if (to.state == RunState::active && from.state != RunState::active) {
        if (from.state != RunState::armed || !e.hand_present) return "active not from armed with a hand";
    }
    if (to.state == RunState::armed && from.state == RunState::fault) return "armed straight from a fault";
    if (to.state == RunState::armed && from.state == RunState::off) return "armed straight from off";
    if (to.state == RunState::armed && from.state == RunState::ready && !e.arm)
        return "armed without a request";
    if (amplifier_on(to.state) && !amplifier_on(from.state) && e.arm_barred) return "armed though barred";
    if (amplifier_on(to.state) && e.trip != RunReason::none && amplifier_on(from.state))
        return "amplifier on despite a trip";
    if (amplifier_on(to.state) && (e.close || e.stop || e.disarm || e.gui_silent))
        return "amplifier on despite the end of the run";
    if (to.state == RunState::active && !e.hand_present) return "force without a hand";
    if (from.state == RunState::fault && to.state == RunState::ready && (!e.reset || device_trip))
        return "fault left";
    if (from.state == RunState::fault && to.state == RunState::fault && to.reason != from.reason)
        return "reason lost";
    if (device_trip && from.state != RunState::off && !e.close && to.state != RunState::fault)
        return "trip ignored";
    if (e.close && to.state != RunState::off) return "not closed";
    if (to.state == RunState::fault && from.state != RunState::fault && to.reason != e.trip)
        return "wrong reason";
    if (to.state == from.state && (to.since != from.since || to.reason != from.reason))
        return "changed in place";
    return {};
}

TEST(StateMachine, force_flows_only_while_active_and_the_amplifier_is_on_only_while_armed_or_active) {
    for (const RunState s :
         {RunState::off, RunState::ready, RunState::armed, RunState::active, RunState::fault}) {
        EXPECT_EQ(force_may_flow(s), s == RunState::active);
        EXPECT_EQ(amplifier_on(s), s == RunState::armed || s == RunState::active);
    }
}

TEST(StateMachine, an_emergency_stop_or_a_lost_device_trips_in_every_state_but_off) {
    for (const RunReason reason : {RunReason::emergency_stop, RunReason::stop_channels, RunReason::lines_lost,
                                   RunReason::amplifier_readback, RunReason::device_lost}) {
        for (const RunState s : {RunState::ready, RunState::armed, RunState::active})
            EXPECT_TRUE(trips(s, reason));
        EXPECT_FALSE(trips(RunState::off, reason));
    }
}

TEST(StateMachine, every_pair_of_events_in_every_state_keeps_the_rules) {
    for (const RunState state : kStates) {
        for (const Named& a : kEvents) {
            for (const Named& b : kEvents) {
                for (const bool hand : {false, true}) {
                    RunEvents e;
                    e.hand_present = hand;
                    a.set(e);
                    b.set(e);
                    RunStatus from = in(state);
                    if (state == RunState::fault) from.reason = RunReason::too_late;
                    const RunStatus to = next_status(from, e, instant_from_ns(5));
                    EXPECT_EQ(broken_rule(from, e, to), "") << "state " << int(state) << ", " << a.name
                                                            << " with " << b.name << ", hand " << hand;
                }
            }
        }
    }
}

TEST(StateMachine, no_two_events_in_sequence_lead_to_a_force_without_an_order) {
    for (const RunState state : {RunState::off, RunState::ready, RunState::fault}) {
        for (const Named& a : kEvents) {
            for (const Named& b : kEvents) {
                RunEvents first, second;
                first.hand_present = second.hand_present = true;
                a.set(first);
                b.set(second);
                const RunStatus after = next_status(next_status(in(state), first, instant_from_ns(2)), second,
                                                    instant_from_ns(3));
                if (after.state == RunState::active) {
                    EXPECT_EQ(state, RunState::ready) << a.name << ", " << b.name;
                    EXPECT_TRUE(first.arm) << a.name << ", " << b.name;
                }
            }
        }
    }
}

TEST(StateMachine, active_requires_open_arm_and_a_hand) {
    RunStatus s;
    s = next_status(s, {.open = true}, instant_from_ns(10));
    EXPECT_EQ(s.state, RunState::ready);
    s = next_status(s, {.hand_present = true}, instant_from_ns(20));
    EXPECT_EQ(s.state, RunState::ready);
    s = next_status(s, {.arm = true}, instant_from_ns(30));
    EXPECT_EQ(s.state, RunState::armed);
    EXPECT_EQ(to_ns(s.since), 30);
    s = next_status(s, {.hand_present = true}, instant_from_ns(40));
    EXPECT_EQ(s.state, RunState::active);
    EXPECT_EQ(s.reason, RunReason::hand_present);
    s = next_status(s, {}, instant_from_ns(50));
    EXPECT_EQ(s.state, RunState::armed);
    EXPECT_EQ(s.reason, RunReason::hand_left);
}

TEST(StateMachine, the_first_fault_persists_through_later_ones) {
    RunStatus s = next_status(in(RunState::active), {.hand_present = true, .trip = RunReason::too_late},
                              instant_from_ns(7));
    s = next_status(s, {.hand_present = true, .trip = RunReason::device_lost}, instant_from_ns(8));
    EXPECT_EQ(s.state, RunState::fault);
    EXPECT_EQ(s.reason, RunReason::too_late);
    EXPECT_EQ(to_ns(s.since), 7);
}

TEST(StateMachine, a_device_that_is_still_lost_cannot_be_reset) {
    const RunStatus fault = in(RunState::fault);
    EXPECT_EQ(next_status(fault, {.reset = true, .trip = RunReason::device_lost}, instant_from_ns(9)).state,
              RunState::fault);
    EXPECT_EQ(next_status(fault, {.reset = true}, instant_from_ns(9)).state, RunState::ready);
}

TEST(StateMachine, lateness_without_power_is_no_fault) {
    EXPECT_EQ(next_status(in(RunState::ready), {.trip = RunReason::too_late}, instant_from_ns(9)).state,
              RunState::ready);
    EXPECT_EQ(next_status(in(RunState::armed), {.trip = RunReason::too_late}, instant_from_ns(9)).state,
              RunState::fault);
}

TEST(StateMachine, the_reasons_that_can_latch_a_fault_are_those_that_trip_in_some_state) {
    for (int r = 0; r <= static_cast<int>(kLastRunReason) + 1; ++r) {
        const auto reason = static_cast<RunReason>(r);
        bool in_some_state = false;
        for (const RunState state : kStates) in_some_state = in_some_state || trips(state, reason);
        EXPECT_EQ(latches_fault(reason), in_some_state) << run_reason_name(reason);
    }
    EXPECT_STREQ(run_reason_name(RunReason::force_not_finite), "force_not_finite");
    EXPECT_STREQ(run_reason_name(RunReason::gui_silent), "gui_silent");
    EXPECT_STREQ(run_reason_name(RunReason::supervisor), "supervisor");
    EXPECT_STREQ(run_reason_name(static_cast<RunReason>(255)), "unknown");
}

}  // namespace
}  // namespace tact::safety_state_machine_test
