// The state machine of the controller: off, ready, armed, active, fault.
//
// Pure      the next state is a function of the current state, the cycle's events and the time
// Order     of several events in one cycle, the safest wins: close, trip, stop, disarm, arm
// Latched   the first fault stays with its reason until a person resets it; a reset leads only to ready
#pragma once

#include "ipc/base/clock.hpp"
#include "ipc/base/run_state.hpp"

namespace tact {

struct RunStatus {
    RunState state = RunState::off;
    RunReason reason = RunReason::none;
    Instant since{};
};

// The events of one cycle.
struct RunEvents {
    bool open = false;  // devices are open and the dry run is over
    bool close = false;
    bool stop = false;  // by a signal or at the end of the run time
    bool arm = false;
    bool disarm = false;
    bool reset = false;
    bool hand_present = false;
    bool arm_barred = false;  // by the safety inputs: arming would trip at once
    bool gui_silent = false;  // only where the configuration asks for a reaction
    RunReason trip = RunReason::none;
};

[[nodiscard]] constexpr bool force_may_flow(RunState s) noexcept { return s == RunState::active; }
[[nodiscard]] constexpr bool amplifier_on(RunState s) noexcept {
    return s == RunState::armed || s == RunState::active;
}

// A lost device and an emergency stop are faults at any time. Timing and value of the force and the dead-man pedal trip
// only while the amplifier is on, so that slow loading or a released pedal needs no reset.
[[nodiscard]] constexpr bool trips(RunState s, RunReason r) noexcept {
    switch (r) {
        case RunReason::device_lost:
        case RunReason::device_fault:
        case RunReason::sample_stale:
        case RunReason::emergency_stop:
        case RunReason::stop_channels:
        case RunReason::amplifier_readback:
        case RunReason::lines_lost:
            return s != RunState::off;
        case RunReason::force_not_finite:
        case RunReason::model_failed:
        case RunReason::overruns:
        case RunReason::too_late:
        case RunReason::dead_man:
        case RunReason::supervisor:
            return amplifier_on(s);
        case RunReason::none:
        case RunReason::by_command:
        case RunReason::hand_present:
        case RunReason::hand_left:
        case RunReason::signal:
        case RunReason::gui_silent:
            return false;
    }
    return false;
}

[[nodiscard]] constexpr RunStatus next_status(const RunStatus& s, const RunEvents& e, Instant now) noexcept {
    const auto to = [now](RunState state, RunReason reason) { return RunStatus{state, reason, now}; };
    if (s.state == RunState::off)
        return e.open && !e.close && !e.stop ? to(RunState::ready, RunReason::none) : s;
    if (e.close) return to(RunState::off, e.stop ? RunReason::signal : RunReason::none);
    if (s.state == RunState::fault) {
        return e.reset && !trips(RunState::ready, e.trip) ? to(RunState::ready, RunReason::by_command) : s;
    }
    if (trips(s.state, e.trip)) return to(RunState::fault, e.trip);
    if (amplifier_on(s.state)) {
        if (e.stop) return to(RunState::ready, RunReason::signal);
        if (e.disarm) return to(RunState::ready, RunReason::by_command);
        if (e.gui_silent) return to(RunState::ready, RunReason::gui_silent);
        if (s.state == RunState::armed && e.hand_present)
            return to(RunState::active, RunReason::hand_present);
        if (s.state == RunState::active && !e.hand_present) return to(RunState::armed, RunReason::hand_left);
        return s;
    }
    if (e.arm && !e.arm_barred && !e.stop && !e.disarm && !e.gui_silent)
        return to(RunState::armed, RunReason::by_command);
    return s;
}

}  // namespace tact
