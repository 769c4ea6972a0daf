// The state machine of an amplifier board from PROTOCOL.md, used by the emulator and required of a board's
// firmware.
//
// Clock    of the device, microseconds, wrapping; tick() at least every millisecond
// Current  zero in every state but on; clamped to the limits of the board
// Watchdog trips exactly 10 ms after the last accepted command with a new heartbeat; off until an enable
// edge 0 -> 1
// Faults   latched; cleared when their cause is gone and enable was low
// Thread   one; TACT_RT
#pragma once

#include "hal/phantom/packets.hpp"

namespace tact::phantom {

enum class AmplifierState : std::uint8_t { off, on, tripped, fault };

class Amplifier {
public:
    Amplifier(std::uint16_t boot, const std::array<std::uint16_t, 6>& current_ma_max,
              std::uint32_t watchdog_us = 10'000) noexcept
        : boot_(boot), max_ma_(current_ma_max), watchdog_us_(watchdog_us) {}

    // Handles received bytes. True: accepted. Refused commands are counted and do not feed the watchdog.
    bool receive(std::span<const std::byte> bytes, std::uint32_t now_us) noexcept TACT_RT;
    // causes: bits of status::kFaults that are present.
    void tick(std::uint32_t now_us, std::uint16_t causes) noexcept TACT_RT;

    [[nodiscard]] AmplifierState state() const noexcept { return state_; }
    [[nodiscard]] const std::array<std::int16_t, 6>& current_ma() const noexcept { return current_ma_; }
    [[nodiscard]] std::uint16_t status() const noexcept;  // bits that it can determine: on, tripped, faults
    [[nodiscard]] std::uint32_t command_seen() const noexcept { return seen_; }
    [[nodiscard]] std::uint8_t refused() const noexcept { return refused_; }

private:
    void drop(AmplifierState to) noexcept;

    std::uint16_t boot_;
    std::array<std::uint16_t, 6> max_ma_;
    std::uint32_t watchdog_us_;
    AmplifierState state_ = AmplifierState::off;
    SequenceGate gate_;
    std::array<std::int16_t, 6> current_ma_{};
    std::uint32_t seen_ = 0, heartbeat_ = 0, fed_us_ = 0;
    std::uint16_t causes_ = 0, latched_ = 0;
    std::uint8_t refused_ = 0;
    bool enable_before_ = true;  // an enable that is high from the start is no edge
};

}  // namespace tact::phantom
