// The state machine between the servo's commands and the output of a manufacturer's library.
//
// Enable    force only after an enable edge, and only while heartbeats arrive: 10 ms without one trip the
//           watchdog, independently of the servo thread
// Fault     latched until enable was low and no error occurred for 100 ms; nothing re-arms automatically:
//           the next enable edge comes from a person
// Thread    the pump's
#pragma once

#include <utility>

#include "hal/vendor/servo_mail.hpp"

namespace tact::vendor {

class OutputGate {
public:
    static constexpr Duration kQuiet = std::chrono::milliseconds(100);  // without errors, to end a fault

    explicit OutputGate(Duration watchdog = std::chrono::milliseconds(10)) noexcept : watchdog_(watchdog) {}

    // Applies the newest command. Not `permitted` (not calibrated): an edge is kept until it is permitted,
    // unless enable falls again. `ended`: a fault stays.
    void apply(const CommandWords& command, Instant now, bool permitted, bool ended) noexcept;
    void fail(Instant now) noexcept {
        state_ = DeviceState::fault;
        failed_at_ = now;
    }
    [[nodiscard]] DeviceState state() const noexcept { return state_; }
    [[nodiscard]] std::uint64_t trips() const noexcept { return trips_; }
    // taken_at_ns of the sample that the last new command answers, once; 0: no new command.
    [[nodiscard]] std::int64_t take_answered() noexcept { return std::exchange(answered_ns_, 0); }

private:
    Duration watchdog_;
    DeviceState state_ = DeviceState::ready;
    std::uint64_t heartbeat_ = 0, edge_ = 0, trips_ = 0;
    std::uint32_t relaxed_ = 0;
    std::int64_t answered_ns_ = 0;
    Instant heard_at_{}, failed_at_{};
};

}  // namespace tact::vendor
