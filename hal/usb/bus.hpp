// Interface of a pump to the USB bus: packets of at most 64 bytes each way, and their faults. One
// implementation uses libusb, others emulate the bus in memory for tests.
//
// In      the bus keeps its own IN transfers queued; each packet that arrives is an event
// Out     one at a time: send() returns false until the event `sent` or `send_failed` arrives
// Gone    after `gone` the bus is closed; open() looks for the device again
// Thread  open() at start-up or on the pump's thread, everything else on the pump's; never on the servo's
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact::usb {

enum class BusFault : std::uint8_t {
    none,
    missing,    // no device, or none with that serial number
    several,    // more than one device, and no serial number given
    twins,      // two devices with the same serial number
    denied,     // no permission to open the device file
    busy,       // another program uses it
    not_ready,  // present, but not configured yet: try again
    slow,       // not at high speed
    failed,     // the bus itself
};

struct BusFinding {
    BusFault fault = BusFault::missing;
    std::string serial;  // of the opened device
    std::string detail;  // of a fault: the serial numbers found, or the bus's own message
};

enum class BusEventKind : std::uint8_t { packet, sent, send_failed, receive_failed, stalled, gone };

struct BusEvent {
    BusEventKind kind = BusEventKind::packet;
    std::uint8_t size = 0;  // of a packet; 65: longer than 64 bytes, and refused
    Instant at{};           // time of arrival
    std::array<std::byte, 64> bytes{};
};

// A vendor request to the device itself, without data.
struct VendorRequest {
    std::uint8_t request = 0;
    std::uint16_t value = 0;
    bool operator==(const VendorRequest&) const = default;
};

class Bus {
public:
    virtual ~Bus() = default;
    // Empty serial: the only device present. On any result but `none` the bus stays closed.
    virtual BusFinding open(const std::string& serial) = 0;
    virtual void close() noexcept = 0;
    // Waits at most `patience` for events; returns their number, the oldest first.
    virtual std::size_t wait(std::span<BusEvent> events, Duration patience) noexcept = 0;
    virtual bool send(std::span<const std::byte> packet) noexcept = 0;
    // After `stalled`: makes both endpoints work again; false on failure.
    virtual bool clear_stall() noexcept = 0;
    // Waits for the device's answer. False: refused, or the bus has no such requests.
    virtual bool control(const VendorRequest& /*request*/) noexcept { return false; }
    virtual Instant now() noexcept = 0;
};

}  // namespace tact::usb
