// Adapts a Haptikfabriken or Polhem board to the interface of the amplifier board in
// hal/phantom/PROTOCOL.md, so that its driver, with calibration, monitoring and limits, also drives this
// board.
//
// Missing   functions that the board lacks run here, on the pump's thread: sequence and time of a state,
//           enable edges, latched faults and a watchdog of 10 ms (hal/phantom/amplifier.hpp). While the
//           amplifier is off, the board receives zero currents.
// Risk      the board's own watchdog takes half a second and restores the force automatically. The restored
//           force is harmless here: after silence the currents stay zero. When the whole process hangs, a
//           force may persist for half a second. Wire an emergency stop.
// Currents  of a state are the commanded ones, since the board measures none
// Thread    see usb::Bus
#pragma once

#include <array>
#include <memory>
#include <string>

#include "hal/phantom/amplifier.hpp"
#include "hal/polhem/hid_port.hpp"
#include "hal/polhem/reports.hpp"
#include "hal/usb/event_queue.hpp"

namespace tact::polhem {

struct PolhemCounts {
    std::uint64_t reports = 0, refused = 0, written = 0, write_failed = 0;
};

class PolhemBus final : public usb::Bus {
public:
    static constexpr std::uint16_t kCurrentMaxMa = 3000;  // the smaller of the boards' two sizes
    static constexpr unsigned kWriteFailsMax = 20;        // in a row: the board counts as disconnected

    explicit PolhemBus(std::unique_ptr<HidPort> port);
    ~PolhemBus() override;
    PolhemBus(const PolhemBus&) = delete;
    PolhemBus& operator=(const PolhemBus&) = delete;

    usb::BusFinding open(const std::string& serial) override;
    void close() noexcept override;
    std::size_t wait(std::span<usb::BusEvent> events, Duration patience) noexcept override;
    bool send(std::span<const std::byte> packet) noexcept override;
    bool clear_stall() noexcept override { return true; }
    Instant now() noexcept override { return port_->now(); }

    [[nodiscard]] const PolhemCounts& counts() const noexcept { return counts_; }

private:
    static constexpr std::size_t kEvents = 16;

    void push(usb::BusEventKind kind, std::span<const std::byte> bytes = {}) noexcept;
    void answer() noexcept;
    void take(std::span<const std::byte> bytes) noexcept;
    bool tell() noexcept;
    void guard() noexcept;
    [[nodiscard]] std::uint32_t us() noexcept;

    std::unique_ptr<HidPort> port_;
    phantom::Amplifier amplifier_;
    Unwrapped counts32_;
    PolhemCounts counts_;
    std::string serial_;
    usb::EventQueue<kEvents> events_;
    std::uint32_t sequence_ = 0, time_us_ = 0;
    std::uint16_t boot_ = 0;
    unsigned fails_ = 0;
    bool open_ = false, moved_ = false;  // moved_: a non-zero current was sent
};

}  // namespace tact::polhem
