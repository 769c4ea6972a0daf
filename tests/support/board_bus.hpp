// An emulated USB bus with one emulated board, and the driver in lockstep with it.
//
// Time    of the bus; wait() advances it while no data is pending, so that open() runs without sleeping. For a
//         driver with a thread of its own the test controls it: no result depends on the speed of the machine.
// Faults  of the board through board().faults(), of the bus through the members here
#pragma once

#include <atomic>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "hal/phantom/phantom_usb.hpp"
#include "tests/emu/board.hpp"

namespace tact::emu {

template <class Settings>
const Settings& usual() {
    static const Settings settings;
    return settings;
}

class BoardBus final : public usb::Bus {
public:
    explicit BoardBus(const BoardSettings& settings) : board_(settings), serial_(settings.serial) {}

    usb::BusFinding open(const std::string& serial) override {
        ++opens;
        last_serial = serial;
        if (finding != usb::BusFault::none && opens <= finds) return {finding, {}, detail};
        if (!plugged || (!serial.empty() && serial != serial_)) return {usb::BusFault::missing, {}, detail};
        open_ = true;
        return {usb::BusFault::none, usb_serial.empty() ? serial_ : usb_serial, {}};
    }
    void close() noexcept override {
        open_ = false;
        events_.clear();
    }
    std::size_t wait(std::span<usb::BusEvent> events, Duration patience) noexcept override {
        if (events_.empty() && patience > Duration{0}) {
            const Duration room = instant_from_ns(held_at_ns_.load(std::memory_order_acquire)) - now_;
            if (room > Duration{0})
                advance(std::min(patience, room));
            else
                std::this_thread::sleep_for(std::chrono::microseconds(20));  // until the test continues
        }
        std::size_t n = 0;
        for (; n < events.size() && !events_.empty(); ++n) {
            events[n] = events_.front();
            events_.pop_front();
        }
        return n;
    }
    bool send(std::span<const std::byte> packet) noexcept override {
        if (!open_) return false;
        ++sends;
        if (stalls > 0) {
            --stalls;
            stalled_ = true;
            push(usb::BusEventKind::stalled);
            return true;
        }
        if (send_fails > 0) {
            --send_fails;
            push(usb::BusEventKind::send_failed);
            return true;
        }
        if (stalled_ || out_hangs) return true;
        board_.receive(packet, us());
        push(usb::BusEventKind::sent);
        return true;
    }
    bool clear_stall() noexcept override {
        ++stalls_cleared;
        stalled_ = false;
        return clears;
    }
    Instant now() noexcept override { return now_; }

    void advance(Duration d) noexcept {
        const Instant end = now_ + d;
        while (now_ < end) {
            now_ = std::min(end, now_ + std::chrono::microseconds(125));
            board_.tick(us());
            std::array<std::byte, 64> packet;
            std::size_t size = 0;
            while (board_.next_packet(packet, size)) {
                if (open_ && !stalled_) push(usb::BusEventKind::packet, std::span(packet).first(size));
            }
        }
        reached_ns_.store(to_ns(now_), std::memory_order_release);
    }
    void push(usb::BusEventKind kind, std::span<const std::byte> bytes = {}) noexcept {
        usb::BusEvent e;
        e.kind = kind;
        e.at = now_;
        e.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 65));
        std::copy_n(bytes.begin(), std::min(bytes.size(), e.bytes.size()), e.bytes.begin());
        events_.push_back(e);
    }
    // Any thread: time stops at t; the second function returns the current time.
    void hold_time_at(Instant t) noexcept { held_at_ns_.store(to_ns(t), std::memory_order_release); }
    [[nodiscard]] Instant reached() const noexcept {
        return instant_from_ns(reached_ns_.load(std::memory_order_acquire));
    }
    // Unplugs the board, which also loses its power.
    void unplug() noexcept {
        plugged = false;
        if (open_) push(usb::BusEventKind::gone);
    }
    void plug() noexcept {
        plugged = true;
        board_.restart(us());
    }

    [[nodiscard]] EmulatedBoard& board() noexcept { return board_; }
    [[nodiscard]] bool is_open() const noexcept { return open_; }

    usb::BusFault finding = usb::BusFault::none;
    unsigned finds = std::numeric_limits<unsigned>::max();  // number of calls of open() that succeed
    std::string detail, usb_serial, last_serial;
    bool plugged = true, out_hangs = false, clears = true;
    unsigned stalls = 0, send_fails = 0, stalls_cleared = 0, opens = 0;
    std::uint64_t sends = 0;

private:
    [[nodiscard]] std::uint32_t us() const noexcept {
        return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_ns(now_)) / 1000U);
    }

    EmulatedBoard board_;
    std::string serial_;
    std::deque<usb::BusEvent> events_;
    bool open_ = false, stalled_ = false;
    Instant now_ = instant_from_ns(4'294'000'000'000);  // the board's clock wraps a second later
    std::atomic<std::int64_t> held_at_ns_{std::numeric_limits<std::int64_t>::max()}, reached_ns_{to_ns(now_)};
};

// Driver, pump and bus in sequence on one thread. The caller advances `now`.
class LockstepPhantom final : public HapticDevice {
public:
    // By reference: g++ 12 takes the end of default arguments for a use of uninitialized strings.
    LockstepPhantom() : LockstepPhantom(usual<BoardSettings>(), usual<PhantomUsbSettings>()) {}
    LockstepPhantom(const BoardSettings& board, PhantomUsbSettings driver) {
        auto bus = std::make_unique<BoardBus>(board);
        bus_ = bus.get();
        driver.thread = false;
        driver.arm = board.arm;
        device_ = std::make_unique<PhantomUsb>(driver, std::move(bus));
    }

    // Also calibrates it, as a person does.
    DeviceInfo open() override {
        const DeviceInfo info = device_->open();
        opened_ = true;
        for (int i = 0; i < 5000 && !ready(); ++i) cycle({});
        return info;
    }
    IoStatus read(DeviceSample& newest, Instant now) noexcept override {
        if (opened_) {
            if (!matched_) offset_ = bus_->now() + std::chrono::milliseconds(1) - now;
            matched_ = true;
            while (bus_->now() < now + offset_) {
                bus_->advance(std::min<Duration>(now + offset_ - bus_->now(), std::chrono::milliseconds(1)));
                device_->pump().round(Duration{0});
            }
        }
        const IoStatus status = device_->read(newest, bus_->now());
        newest.taken_at -= offset_;
        return status;
    }
    IoStatus write(const DeviceCommand& command, Instant /*now*/) noexcept override {
        const IoStatus status = device_->write(command, bus_->now());
        if (opened_) device_->pump().round(Duration{0});
        return status;
    }
    void relax() noexcept override { device_->relax(); }

    // One millisecond, one read, one write.
    IoStatus cycle(DeviceCommand command) noexcept {
        bus_->advance(std::chrono::milliseconds(1));
        device_->pump().round(Duration{0});
        const IoStatus status = device_->read(sample, bus_->now());
        command.heartbeat = ++heartbeat_;
        write_status = device_->write(command, bus_->now());
        device_->pump().round(Duration{0});
        return status;
    }
    [[nodiscard]] BoardBus& bus() noexcept { return *bus_; }
    [[nodiscard]] EmulatedBoard& board() noexcept { return bus_->board(); }
    [[nodiscard]] PhantomUsb& device() noexcept { return *device_; }
    [[nodiscard]] phantom::PumpNews news() noexcept {
        phantom::PumpNews n;
        static_cast<void>(device_->pump().read(n));
        return n;
    }

    DeviceSample sample;
    IoStatus write_status = IoStatus::ok;

private:
    [[nodiscard]] bool ready() const noexcept {
        return device_->calibration() == CalibrationState::done && bus_->board().hand_free();
    }

    BoardBus* bus_ = nullptr;
    std::unique_ptr<PhantomUsb> device_;
    bool opened_ = false, matched_ = false;
    Duration offset_{0};
    std::uint64_t heartbeat_ = 1'000'000;  // the test's own
};

}  // namespace tact::emu
