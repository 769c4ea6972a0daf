// Packets between the PC and the Falcon's own firmware, see PROTOCOL.md. Shared by driver, tests and
// fuzzing.
//
// Bytes    16 each way: '<', twelve digits, one byte of bits, one unknown, '>'; a digit is four bits plus
//          'A'
// Units    integers as in the packet: steps of torque, counts of the encoders
// Errors   a counted fault; without checksum and sequence number, a byte outside its range is the only sign
//          of a bad packet. A refused packet does not change `out`.
// Thread   any; TACT_RT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/base/rt.hpp"

namespace tact::falcon {

inline constexpr std::size_t kPacketBytes = 16;

enum class PacketFault : std::uint8_t { none, frame, digit, bits };
inline constexpr std::size_t kPacketFaults = 4;

namespace led {
inline constexpr std::uint8_t kGreen = 1U << 1U, kBlue = 1U << 2U, kRed = 1U << 3U;
inline constexpr std::uint8_t kAll = kGreen | kBlue | kRed;
}  // namespace led

inline constexpr std::uint8_t kHomedAll = 7;

// PC to device. The device answers each with one reply.
struct Request {
    std::array<std::int16_t, 3> torque{};
    std::uint8_t leds = 0;  // bits of led
    bool homing = false;    // requests that the encoders search their marks
    bool operator==(const Request&) const = default;
};

// Device to PC.
struct Reply {
    std::array<std::int16_t, 3> counts{};
    std::uint8_t buttons = 0;  // four bits
    std::uint8_t homed = 0;    // three bits, one per encoder whose counts are valid
    bool operator==(const Reply&) const = default;
};

[[nodiscard]] std::array<std::byte, kPacketBytes> encode(const Request& request) noexcept TACT_RT;
[[nodiscard]] std::array<std::byte, kPacketBytes> encode(const Reply& reply) noexcept TACT_RT;
[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, Request& out) noexcept TACT_RT;
[[nodiscard]] PacketFault decode(std::span<const std::byte> bytes, Reply& out) noexcept TACT_RT;

// Decodes replies from a stream of bytes in pieces of any size. After a fault it continues at the next '<'.
class ReplyStream {
public:
    // True: this byte completed a good reply, now in `out`.
    bool push(std::byte byte, Reply& out) noexcept TACT_RT;
    void reset() noexcept TACT_RT { size_ = 0; }

    struct Counts {
        std::uint64_t good = 0;
        std::array<std::uint64_t, kPacketFaults> refused{};  // by PacketFault
        std::uint64_t skipped = 0;                           // bytes outside of packets
    };
    [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

private:
    std::array<std::byte, kPacketBytes> bytes_{};
    std::size_t size_ = 0;
    Counts counts_;
};

}  // namespace tact::falcon
