// Makes a Haptikfabriken or Polhem board look like the amplifier board of hal/phantom/PROTOCOL.md, so that the
// driver for that one, with its calibration, watches and limits, drives this one too.
//
// Missing   what the board does not do is done here, on the pump's thread: sequence and time of a state,
//           enable edges, latched faults and a watchdog of 10 ms (hal/phantom/amplifier.hpp). While the
//           amplifier is off the board is told zero currents.
// Left      the board's own watchdog takes half a second and lets the force back by itself. The latter is
//           harmless here: after silence the currents stay zero. The former is what remains when the whole
//           process stands still: a force may stand for half a second. Wire an emergency stop.
// Currents  of a state are those that were commanded, since the board measures none
// Thread    as usb::Bus says
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
    static constexpr unsigned kWriteFailsMax = 20;        // in a row: it is as good as gone

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
    bool open_ = false, moved_ = false;  // moved_: the board was told a current other than zero
};

}  // namespace tact::polhem
