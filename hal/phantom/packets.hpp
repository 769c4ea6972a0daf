// Packets between the PC and an arm's amplifier board, see PROTOCOL.md; shared by driver and emulator.
//
// Bytes    little endian, fixed sizes, at most 64, CRC-32 at the end; reserved bytes are zero
// Units    integers as in the packet: counts, milliamperes, microseconds of the device's clock
// Errors   a PacketFault; a refused packet does not change `out`, so it can never become a force or a
//          position
// Thread   any; TACT_RT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/base/rt.hpp"

namespace tact::phantom {

inline constexpr std::uint16_t kMagic = 0x4154;  // "TA"
inline constexpr std::uint8_t kVersion = 1;      // of state and command; query and info never change
inline constexpr std::size_t kStateBytes = 64, kCommandBytes = 32, kInfoBytes = 64, kQueryBytes = 16;

enum class PacketFault : std::uint8_t { none, size, magic, version, kind, checksum, reserved, text };
inline constexpr std::size_t kPacketFaults = 8;

namespace status {
inline constexpr std::uint16_t kCalibrated = 1U << 0U;  // the counts are absolute
inline constexpr std::uint16_t kAmplifierOn = 1U << 1U;
inline constexpr std::uint16_t kOverTemperature = 1U << 2U;
inline constexpr std::uint16_t kBrownOut = 1U << 3U;
inline constexpr std::uint16_t kWatchdogTripped = 1U << 4U;
inline constexpr std::uint16_t kSafetyOpen = 1U << 5U;  // emergency stop or dead-man, wired to the board
inline constexpr std::uint16_t kOverCurrent = 1U << 6U;
inline constexpr std::uint16_t kCountLost = 1U << 7U;  // an encoder lost counts: calibrate again
inline constexpr std::uint16_t kAll = 0xFFU;
inline constexpr std::uint16_t kFaults = kOverTemperature | kBrownOut | kSafetyOpen | kOverCurrent;
}  // namespace status

namespace input {
inline constexpr std::uint16_t kButtons = 0xFFU;  // bit 0: clutch
inline constexpr std::uint16_t kInkwell = 1U << 8U;
inline constexpr std::uint16_t kAll = 0x1FFU;
}  // namespace input

// Device to PC, every period.
struct State {
    std::uint32_t sequence = 0;
    std::uint32_t time_us = 0;       // time at which the counts were latched
    std::uint32_t command_seen = 0;  // sequence of the newest accepted command
    std::array<std::int32_t, 6> counts{};
    std::array<std::int16_t, 6> current_ma{};  // measured
    std::uint16_t status = 0, inputs = 0;
    std::uint16_t boot = 0;             // changes with every start of the device
    std::uint8_t commands_refused = 0;  // rises, and wraps
    bool operator==(const State&) const = default;
};

// PC to device, every cycle.
struct Command {
    std::uint32_t sequence = 0;
    std::uint32_t heartbeat = 0;  // of the servo; a constant value counts as silence
    std::array<std::int16_t, 6> current_ma{};
    bool enable = false;
    std::uint16_t boot = 0;  // of the target; the board refuses any other
    bool operator==(const Command&) const = default;
};

// PC to device: the versions that the PC supports. The device answers with Info.
struct Query {
    std::uint8_t version_low = kVersion, version_high = kVersion;
    bool operator==(const Query&) const = default;
};

struct Info {
    std::uint8_t version_low = kVersion, version_high = kVersion;
    std::uint16_t boot = 0;
    std::uint16_t rate_hz = 1000;  // of the states
    std::uint16_t watchdog_ms = 10;
    std::array<char, 16> serial{}, model{};  // printable ASCII, zeros at the end
    std::array<std::uint16_t, 6> current_ma_max{};
    bool operator==(const Info&) const = default;
};

// Serial number or model up to the first zero; the view is valid as long as `chars`.
[[nodiscard]] std::string_view text_of(const std::array<char, 16>& chars) noexcept TACT_RT;

[[nodiscard]] std::array<std::byte, kStateBytes> encode(const State& state) noexcept TACT_RT;
[[nodiscard]] std::array<std::byte, kCommandBytes> encode(const Command& command) noexcept TACT_RT;
[[nodiscard]] std::array<std::byte, kQueryBytes> encode(const Query& query) noexcept TACT_RT;
[[nodiscard]] std::array<std::byte, kInfoBytes> encode(const Info& info) noexcept TACT_RT;

[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, State& out) noexcept TACT_RT;
[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, Command& out) noexcept TACT_RT;
[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, Query& out) noexcept TACT_RT;
[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, Info& out) noexcept TACT_RT;

// The highest version that both support; 0: none.
[[nodiscard]] std::uint8_t common_version(const Query& pc, const Info& device) noexcept TACT_RT;

// Detects new packets. A packet is accepted when its sequence is ahead of the newest one, across the wrap,
// and, for states, when the device's clock advanced too.
enum class Order : std::uint8_t { taken, repeated, stale, clock, restarted };

class SequenceGate {
public:
    // restarted: the boot number changed; accepts nothing until reset().
    Order check(std::uint16_t boot, std::uint32_t sequence, std::uint32_t time_us) noexcept TACT_RT;
    Order check(std::uint16_t boot, std::uint32_t sequence) noexcept TACT_RT;
    void reset() noexcept TACT_RT { *this = SequenceGate(); }

    struct Counts {
        std::uint64_t taken = 0, repeated = 0, stale = 0, clock = 0, restarted = 0;
        std::uint64_t lost = 0;  // sequence numbers that never arrived, or arrived too late
    };
    [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

private:
    Order refused(std::uint16_t boot, std::uint32_t sequence) noexcept;
    void take(std::uint16_t boot, std::uint32_t sequence) noexcept;

    bool started_ = false, timed_ = false;
    std::uint16_t boot_ = 0;
    std::uint32_t newest_ = 0, newest_us_ = 0;
    Counts counts_;
};

}  // namespace tact::phantom
