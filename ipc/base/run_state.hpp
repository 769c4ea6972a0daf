// The states of the controller, and why it is in one: decided in rt/safety, published in the health topic.
#pragma once

#include <cstdint>

namespace tact {

// off     no device, or leaving
// ready   device open, amplifier off
// armed   amplifier on, no force: nobody holds the device
// active  force on
// fault   latched: amplifier off until a person resets it
enum class RunState : std::uint8_t { off, ready, armed, active, fault };

// The text for people is run_reason_text() in ipc/topics/text.hpp.
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
    model_failed,
    emergency_stop,
    stop_channels,  // the two of the emergency stop disagree
    dead_man,
    amplifier_readback,
    lines_lost,
    supervisor,
};

}  // namespace tact
