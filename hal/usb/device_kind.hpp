// The kind of USB device that a driver searches for, and the format of its transfers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tact::usb {

// The useful part of an IN transfer. Empty and undamaged: nothing to report.
struct Piece {
    std::span<const std::byte> bytes;
    bool damaged = false;
};

struct DeviceKind {
    std::uint16_t vendor = 0, product = 0;  // 0 and 0: any
    std::uint32_t interface = 0;  // class, subclass and protocol, 8 bits each; 0: the first interface
    bool bulk = false;            // its endpoints; otherwise interrupt endpoints
    bool high_speed = false;      // a slower connection is BusFault::slow
    Piece (*unpack)(std::span<const std::byte> transfer) noexcept = nullptr;  // null: a transfer is a packet
};

}  // namespace tact::usb
