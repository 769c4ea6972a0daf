// The states of the controller with their reasons: set by rt/safety, published in the health topic.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact {

// off     no device, or shutting down
// ready   device open, amplifier off
// armed   amplifier on, no force: no person holds the device
// active  force on
// fault   latched: amplifier off until a person resets it
enum class RunState : std::uint8_t { off, ready, armed, active, fault };

// run_reason_text() in ipc/topics/text.hpp gives the text for people.
enum class RunReason : std::uint8_t {
    none,
    by_command,
    hand_present,
    hand_left,
    signal,
    force_not_finite,
    sample_stale,
    device_lost,
    device_fault,
    overruns,
    too_late,
    gui_silent,
    model_failed,  // no longer used; kept because recordings store the reason's number
    emergency_stop,
    stop_channels,  // the two channels of the emergency stop disagree
    dead_man,
    amplifier_readback,
    lines_lost,
    supervisor,
};
inline constexpr RunReason kLastRunReason = RunReason::supervisor;

// True if the reason can latch a fault in any state; rt/safety/state_machine.hpp decides in which.
[[nodiscard]] constexpr bool latches_fault(RunReason reason) noexcept {
    switch (reason) {
        case RunReason::force_not_finite:
        case RunReason::sample_stale:
        case RunReason::device_lost:
        case RunReason::device_fault:
        case RunReason::overruns:
        case RunReason::too_late:
        case RunReason::model_failed:
        case RunReason::emergency_stop:
        case RunReason::stop_channels:
        case RunReason::dead_man:
        case RunReason::amplifier_readback:
        case RunReason::lines_lost:
        case RunReason::supervisor:
            return true;
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

// Name for programs, such as a metric label: stable when the text for people changes.
[[nodiscard]] constexpr const char* run_reason_name(RunReason reason) noexcept {
    constexpr const char* kNames[] = {"none",
                                      "by_command",
                                      "hand_present",
                                      "hand_left",
                                      "signal",
                                      "force_not_finite",
                                      "sample_stale",
                                      "device_lost",
                                      "device_fault",
                                      "overruns",
                                      "too_late",
                                      "gui_silent",
                                      "model_failed",
                                      "emergency_stop",
                                      "stop_channels",
                                      "dead_man",
                                      "amplifier_readback",
                                      "lines_lost",
                                      "supervisor"};
    static_assert(sizeof kNames / sizeof kNames[0] == static_cast<std::size_t>(kLastRunReason) + 1);
    return reason <= kLastRunReason ? kNames[static_cast<std::size_t>(reason)] : "unknown";
}

}  // namespace tact
