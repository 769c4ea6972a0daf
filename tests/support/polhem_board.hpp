// An emulated Haptikfabriken board: the emulated arm of tests/emu with reports of 14 bytes and the board's own
// watchdog of half a second, which restores the force by itself.
#pragma once

#include <algorithm>
#include <deque>
#include <memory>

#include "hal/phantom/phantom_usb.hpp"
#include "hal/polhem/polhem_bus.hpp"
#include "tests/emu/board.hpp"

namespace tact::emu {

class PolhemBoard final : public polhem::HidPort {
public:
    explicit PolhemBoard(const BoardSettings& settings) : board_(settings), boot_(settings.boot) {
        board_.receive(phantom::encode(phantom::Query{}), us());
    }

    usb::BusFinding open(const std::string& serial) override {
        if (!plugged || (!serial.empty() && serial != "PH-1")) return {usb::BusFault::missing, {}, {}};
        open_ = true;
        return {usb::BusFault::none, "PH-1", {}};
    }
    void close() noexcept override {
        open_ = false;
        reports.clear();
    }
    int read(std::span<std::byte> into, Duration patience) noexcept override {
        if (reports.empty() && patience > Duration{0}) advance(patience);
        if (!open_ || !plugged) return polhem::kPortGone;
        if (reports.empty()) return 0;
        const auto report = reports.front();
        reports.pop_front();
        const std::size_t size = std::min(into.size(), report.size());
        std::copy_n(report.begin(), size, into.begin());
        return static_cast<int>(size);
    }
    bool write(std::span<const std::byte> report) noexcept override {
        polhem::OutReport out;
        if (!open_ || !plugged || deaf || !polhem::decode(report, out)) return false;
        current_ma = out.current_ma;
        command = out.command;
        told_at_ = now_;
        ++writes;
        return true;
    }
    Instant now() noexcept override { return now_; }

    void advance(Duration d) noexcept {
        const Instant end = now_ + d;
        while (now_ < end) {
            now_ = std::min(end, now_ + std::chrono::microseconds(250));
            drive();
            board_.tick(us());
            std::array<std::byte, 64> packet;
            std::size_t size = 0;
            phantom::State s;
            while (board_.next_packet(packet, size)) {
                if (!open_ || silent ||
                    decode(std::span(packet).first(size), s) != phantom::PacketFault::none)
                    continue;
                polhem::InReport in;
                for (std::size_t i = 0; i < 6; ++i)
                    in.encoder[i] = static_cast<std::int16_t>(static_cast<std::uint32_t>(s.counts[i]));
                in.info = s.inputs & 0xFFU;
                const auto bytes = polhem::encode(in);
                reports.emplace_back(bytes.begin(), bytes.end());
            }
        }
    }
    [[nodiscard]] EmulatedBoard& board() noexcept { return board_; }

    std::deque<std::vector<std::byte>> reports;
    std::array<std::int16_t, 3> current_ma{};
    std::int16_t command = 0;
    std::uint64_t writes = 0;
    bool plugged = true, silent = false, deaf = false;

private:
    [[nodiscard]] std::uint32_t us() const noexcept {
        return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_ns(now_)) / 1000U);
    }
    void drive() noexcept {
        phantom::Command c;
        c.sequence = ++sequence_;
        c.heartbeat = sequence_;
        c.boot = boot_;
        if (now_ - told_at_ < std::chrono::milliseconds(500))
            std::copy(current_ma.begin(), current_ma.end(), c.current_ma.begin());
        c.enable = c.current_ma != std::array<std::int16_t, 6>{};
        board_.receive(phantom::encode(c), us());
    }

    EmulatedBoard board_;
    std::uint16_t boot_;
    bool open_ = false;
    std::uint32_t sequence_ = 0;
    Instant now_ = instant_from_ns(4'294'000'000'000), told_at_ = now_;
};

// Driver, pump and board in sequence on one thread. The caller advances `now`.
class LockstepPolhem final : public HapticDevice {
public:
    LockstepPolhem() {
        const BoardSettings board;
        auto port = std::make_unique<PolhemBoard>(board);
        port_ = port.get();
        auto bus = std::make_unique<polhem::PolhemBus>(std::move(port));
        bus_ = bus.get();
        PhantomUsbSettings driver;
        driver.thread = false;
        driver.arm = board.arm;
        device_ = std::make_unique<PhantomUsb>(driver, std::move(bus));
    }

    DeviceInfo open() override {
        const DeviceInfo info = device_->open();
        opened_ = true;
        for (int i = 0;
             i < 5000 && !(device_->calibration() == CalibrationState::done && port_->board().hand_free());
             ++i)
            cycle({});
        return info;
    }
    IoStatus read(DeviceSample& newest, Instant now) noexcept override {
        if (opened_) {
            if (!matched_) offset_ = port_->now() + std::chrono::milliseconds(1) - now;
            matched_ = true;
            while (port_->now() < now + offset_) pass(now + offset_ - port_->now());
        }
        const IoStatus status = device_->read(newest, port_->now());
        newest.taken_at -= offset_;
        return status;
    }
    IoStatus write(const DeviceCommand& command, Instant /*now*/) noexcept override {
        const IoStatus status = device_->write(command, port_->now());
        if (opened_) device_->pump().round(Duration{0});
        return status;
    }
    void relax() noexcept override { device_->relax(); }

    // One millisecond, one read, one write.
    IoStatus cycle(DeviceCommand given) noexcept {
        pass(std::chrono::milliseconds(1));
        const IoStatus status = device_->read(sample, port_->now());
        given.heartbeat = ++heartbeat_;
        static_cast<void>(device_->write(given, port_->now()));
        device_->pump().round(Duration{0});
        return status;
    }
    // At most a millisecond without the servo.
    void pass(Duration d) noexcept {
        port_->advance(std::min<Duration>(d, std::chrono::milliseconds(1)));
        device_->pump().round(Duration{0});
    }
    [[nodiscard]] PolhemBoard& port() noexcept { return *port_; }
    [[nodiscard]] polhem::PolhemBus& bus() noexcept { return *bus_; }

    DeviceSample sample;

private:
    PolhemBoard* port_ = nullptr;
    polhem::PolhemBus* bus_ = nullptr;
    std::unique_ptr<PhantomUsb> device_;
    bool opened_ = false, matched_ = false;
    Duration offset_{0};
    std::uint64_t heartbeat_ = 1'000'000;  // the test's own
};

}  // namespace tact::emu
