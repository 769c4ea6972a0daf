#include "hal/vendor/output_gate.hpp"

namespace tact::vendor {

void OutputGate::apply(const CommandWords& command, Instant now, bool permitted, bool ended) noexcept {
    if (command.heartbeat != heartbeat_) {
        heartbeat_ = command.heartbeat;
        heard_at_ = now;
        answered_ns_ = command.answers_ns;
    }
    const bool on = command.enable != 0;
    const bool edge = on && command.edge != edge_;
    const bool relaxed = command.relaxed != relaxed_;
    if (permitted || relaxed || state_ == DeviceState::fault) edge_ = command.edge;
    relaxed_ = command.relaxed;
    if (state_ == DeviceState::fault) {
        if (!on && now - failed_at_ >= kQuiet && !ended) state_ = DeviceState::ready;
        return;
    }
    if (!on || (relaxed && !edge)) {
        state_ = DeviceState::ready;
    } else if (edge && permitted) {
        state_ = DeviceState::powered;
    }
    if (state_ == DeviceState::powered && now - heard_at_ > watchdog_) {
        state_ = DeviceState::watchdog_tripped;
        ++trips_;
    }
}

}  // namespace tact::vendor
