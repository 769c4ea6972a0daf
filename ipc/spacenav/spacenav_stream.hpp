// What spacenavd sends to a client: packets of eight 32-bit numbers of this machine.
//
// Events    motion (deflection of the cap on six axes), buttons, devices that come and go; others are ignored
// Hostile   any bytes in any portions: unknown packets and impossible numbers are refused and counted, the rest is bounded. After
//           kBadMost bad packets in a row the stream is lost: what follows begins at an unknown place, so the connection is to be
//           made again.
// Absent    without a device, and once lost, no axis is deflected and no button pressed
// Source    spacenavd 1.1 and libspnav 1.0, src/proto.h: protocol version 1; version 0 has motion and buttons alone
// Thread    any; plain data
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tact {

enum class SpacenavDevice : std::uint8_t { unknown, absent, present };  // unknown: the daemon was not asked

struct SpacenavState {
    static constexpr std::int32_t kAxisMost = 100'000;  // larger values are refused
    static constexpr std::uint32_t kButtons = 32;       // further ones are ignored
    // Of the cap: x right, y up, z away from the person; rotation about them in libspnav's sense (spnav_posrot_moveobj).
    // About 350 at full deflection at spacenavd's default sensitivity.
    std::array<std::int32_t, 6> axes{};
    std::uint32_t buttons = 0;  // held, bit 0: the first one
    std::uint32_t pressed = 0;  // since take_pressed(), also if released since
    SpacenavDevice device = SpacenavDevice::unknown;
    std::int32_t type = 0;     // SPNAV_DEV_... of <spnav.h>; 0: unknown
    std::uint64_t events = 0;  // accepted packets
    std::uint64_t refused = 0;
};

class SpacenavStream {
public:
    static constexpr std::size_t kPacketBytes = 32;
    static constexpr int kBadMost = 4;
    using Packet = std::array<std::int32_t, 8>;

    void add(std::span<const std::byte> bytes);
    [[nodiscard]] const SpacenavState& state() const { return state_; }
    [[nodiscard]] bool lost() const { return bad_in_row_ >= kBadMost; }
    // True once after each event from which the device is to be asked for.
    [[nodiscard]] bool take_device_changed();
    [[nodiscard]] std::uint32_t take_pressed();
    // A request of the device's type; the answer is a packet of this stream.
    [[nodiscard]] static Packet device_type_request();

private:
    void packet(const Packet& p);
    [[nodiscard]] bool accept(const Packet& p);
    void release();

    std::array<std::byte, kPacketBytes> part_{};
    std::size_t have_ = 0;
    int bad_in_row_ = 0;
    bool device_changed_ = false;
    SpacenavState state_;
};

}  // namespace tact
