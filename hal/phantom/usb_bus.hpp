// The bus as the pump sees it: packets of at most 64 bytes each way, and what can happen to them. One
// implementation speaks libusb, one is made of memory for tests.
//
// In      the bus keeps its own IN transfers queued; what came is an event
// Out     one at a time: send() says no until the event `sent` or `send_failed` came
// Gone    after `gone` the bus is closed; open() looks for the board again
// Thread  open() at start-up or on the pump's thread, everything else on the pump's; never on the servo's
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact::phantom {

enum class BusFault : std::uint8_t {
    none,
    missing,    // no board, or none of that serial
    several,    // more than one board, and no serial was asked for
    twins,      // two boards of one serial
    denied,     // the file of the device may not be opened
    busy,       // another program has it
    not_ready,  // there, and not configured yet: try again
    slow,       // not at high speed
    failed,     // the bus itself
};

struct BusFinding {
    BusFault fault = BusFault::missing;
    std::string serial;  // of the opened board
    std::string detail;  // the serials there are, or what the bus said
};

enum class BusEventKind : std::uint8_t { packet, sent, send_failed, receive_failed, stalled, gone };

struct BusEvent {
    BusEventKind kind = BusEventKind::packet;
    std::uint8_t size = 0;  // of a packet; 65: it was longer than 64 bytes, and is refused
    Instant at{};           // when it came
    std::array<std::byte, 64> bytes{};
};

class UsbBus {
public:
    virtual ~UsbBus() = default;
    // Empty serial: the only board there is. Anything but `none` leaves it closed.
    virtual BusFinding open(const std::string& serial) = 0;
    virtual void close() noexcept = 0;
    // Waits for at most so long until something happened; gives how many events it wrote, the oldest first.
    virtual std::size_t wait(std::span<BusEvent> events, Duration patience) noexcept = 0;
    virtual bool send(std::span<const std::byte> packet) noexcept = 0;
    // After `stalled`: both endpoints work again, or false.
    virtual bool clear_stall() noexcept = 0;
    virtual Instant now() noexcept = 0;
};

}  // namespace tact::phantom
