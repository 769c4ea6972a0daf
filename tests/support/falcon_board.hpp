// An emulated Falcon according to PROTOCOL.md: converter, loader, firmware, legs, and a hand of 0.25 kg at the grip;
// and the driver in lockstep with it.
//
// Time    of the board; wait() advances it while no data is pending, so that open() runs without sleeping
// Faults  members of FalconBoard
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hal/falcon/falcon.hpp"

namespace tact::emu {

class FalconBoard final : public usb::Bus {
public:
    using Kind = usb::BusEventKind;

    static std::vector<std::byte> firmware_of(std::size_t size) {
        std::vector<std::byte> out(size);
        for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 7U + i / 256U);
        return out;
    }

    usb::BusFinding open(const std::string& serial) override {
        ++opens;
        if (finding != usb::BusFault::none) return {finding, {}, detail};
        if (!plugged || (!serial.empty() && serial != "FA-1")) return {usb::BusFault::missing, {}, detail};
        open_ = true;
        return {usb::BusFault::none, "FA-1", {}};
    }
    void close() noexcept override {
        open_ = false;
        events_.clear();
        coming_.clear();
    }
    std::size_t wait(std::span<usb::BusEvent> events, Duration patience) noexcept override {
        if (real_time_) {
            if (events_.empty()) std::this_thread::sleep_for(patience);
            advance(Monotonic::now() - now_);
        } else if (events_.empty() && patience > Duration{0}) {
            advance(patience);
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
        if (stall) {
            push(Kind::stalled, {});
            return true;
        }
        push(deaf ? Kind::send_failed : Kind::sent, {});
        for (const std::byte b : packet) {
            if (!deaf) hear(b);
        }
        return true;
    }
    bool clear_stall() noexcept override {
        ++stalls_cleared;
        stall = false;
        return true;
    }
    bool control(const usb::VendorRequest& r) noexcept override {
        if (!open_ || refuses_settings) return false;
        if (r.request == 3) baud_ = r;
        if (r == falcon::ftdi::kDtrLow) dtr_ = false;
        if (r == falcon::ftdi::kForgetIn) {
            ++forgotten;
            events_.clear();
            if (!late_bytes_survive) coming_.clear();
        }
        if (r == falcon::ftdi::kDtrHigh && !dtr_) {  // restarts, not homed
            dtr_ = true;
            restart();
        }
        return true;
    }
    Instant now() noexcept override {
        if (real_time_) advance(Monotonic::now() - now_);
        return now_;
    }

    void advance(Duration d) noexcept {
        const Instant end = now_ + d;
        while (now_ < end) {
            const Instant next = std::min(end, now_ + std::chrono::microseconds(125));
            move(to_s(next - now_));
            now_ = next;
            while (!coming_.empty() && coming_.front().at <= now_) {
                push(Kind::packet, coming_.front().bytes, coming_.front().at);
                coming_.pop_front();
            }
        }
    }
    void run_in_real_time() noexcept {
        real_time_ = true;
        now_ = Monotonic::now();
    }
    void unplug() noexcept {
        plugged = false;
        if (open_) push(Kind::gone, {});
    }
    void plug() noexcept {
        plugged = true;
        restart();
    }
    // Homes it as a person does, by pushing the grip all the way in.
    void push_through() noexcept { homed = falcon::kHomedAll; }
    void restart() noexcept {
        runs = awake_ = false;
        homed = 0;
        torque = {};
        shown_ = {};
        heard_.clear();
        loaded.clear();
    }
    // Bytes on the line, as if the device had sent them.
    void say(std::span<const std::byte> bytes, Duration after = std::chrono::microseconds(700)) {
        coming_.push_back({now_ + after, {bytes.begin(), bytes.end()}});
    }
    [[nodiscard]] const Vec3& grip_m() const noexcept { return grip_m_; }
    // Current force of the motors.
    [[nodiscard]] Vec3 force_n() const noexcept {
        return legs_.force_n(legs_.configuration(grip_m_), shown_);
    }
    [[nodiscard]] bool is_open() const noexcept { return open_; }

    bool plugged = true, deaf = false, mute = false, stall = false, refuses_settings = false;
    bool late_bytes_survive = false;
    bool runs = true;  // the firmware runs
    std::uint8_t homed = 0, buttons = 0;
    std::array<std::int16_t, 3> shift{};  // offset of the counts
    std::array<std::int16_t, 3> torque{};
    std::uint8_t leds = 0;
    std::vector<std::byte> firmware = firmware_of(700), loaded;
    std::size_t wrong_echo_at = SIZE_MAX, wrong_echoes = 0;
    unsigned opens = 0, requests = 0, stalls_cleared = 0, forgotten = 0, hellos_missed = 0, loads = 0;
    std::vector<std::byte> instead;  // replaces the next reply
    bool instead_set = false;
    Duration reply_after = std::chrono::microseconds(700);
    usb::BusFault finding = usb::BusFault::none;
    std::string detail;

private:
    struct Coming {
        Instant at;
        std::vector<std::byte> bytes;
    };

    void push(Kind kind, std::span<const std::byte> bytes) noexcept { push(kind, bytes, now_); }
    void push(Kind kind, std::span<const std::byte> bytes, Instant at) noexcept {
        do {  // a packet of the converter holds 62
            usb::BusEvent e;
            e.kind = kind;
            e.at = at;
            const auto piece = bytes.first(std::min(bytes.size(), falcon::ftdi::kPieceBytes));
            e.size = static_cast<std::uint8_t>(piece.size());
            std::copy(piece.begin(), piece.end(), e.bytes.begin());
            bytes = bytes.subspan(piece.size());
            events_.push_back(e);
        } while (!bytes.empty());
    }
    void hear(std::byte b) noexcept {
        heard_.push_back(b);
        if (runs) return hear_request();
        const std::vector<std::byte> hello{std::byte{0x0A}, std::byte{0x43}, std::byte{0x0D}};
        if (baud_ == falcon::ftdi::kBaud9600 && heard_.size() >= 3 &&
            std::equal(hello.begin(), hello.end(), heard_.end() - 3)) {
            heard_.clear();
            if (hellos_missed > 0) {
                --hellos_missed;
                return;
            }
            // Some converters send a zero first.
            const std::array back{std::byte{0}, std::byte{0x0A}, std::byte{0x44}, std::byte{0x2C},
                                  std::byte{0x0D}};
            return say(back);
        }
        if (baud_ != falcon::ftdi::kBaud143k) return;
        const bool wake = !awake_ && b == std::byte{0x41};
        if (wake) {
            awake_ = true;
            loaded.clear();
            return say(std::array{b});
        }
        if (!awake_) return;
        loaded.push_back(b);
        const bool wrong = loaded.size() == wrong_echo_at + 1 && wrong_echoes > 0;
        if (wrong) --wrong_echoes;
        const std::array back{wrong ? ~b : b};
        if (!mute) say(back);
        if (wrong) awake_ = false;
        if (loaded != firmware) return;
        ++loads;
        awake_ = false;
        runs = true;
        heard_.clear();
    }
    void hear_request() noexcept {
        if (baud_ != falcon::ftdi::kBaud1500k || heard_.size() < falcon::kPacketBytes) return;
        falcon::Request request;
        const bool good =
            decode(std::span(heard_).last(falcon::kPacketBytes), request) == falcon::PacketFault::none;
        if (!good) return;
        heard_.clear();
        ++requests;
        leds = request.leds;
        torque = request.torque;
        shown_ = request.torque;
        if (mute) return;
        if (std::exchange(instead_set, false)) return say(instead, reply_after);
        falcon::Reply reply;
        Vec3 rad;
        static_cast<void>(legs_.inverse(grip_m_, rad));
        reply.counts = legs_.counts(rad);
        for (std::size_t i = 0; i < 3; ++i) {
            const bool known = (homed >> i & 1U) != 0;
            reply.counts[i] = static_cast<std::int16_t>(reply.counts[i] + (known ? shift[i] : 12345));
        }
        reply.homed = homed;
        reply.buttons = buttons;
        say(encode(reply), reply_after);
    }
    void move(double dt_s) noexcept {
        if (shown_ == falcon::Torque3{} && speed_m_s_.norm() < 1e-6) return;
        constexpr double kMassKg = 0.25, kDampingNSM = 5.0;
        speed_m_s_ += (force_n() - kDampingNSM * speed_m_s_) * (dt_s / kMassKg);
        grip_m_ += speed_m_s_ * dt_s;
        const Vec3 held = grip_m_.cwiseMax(-falcon::kWorkspaceHalfM).cwiseMin(falcon::kWorkspaceHalfM);
        if (held != grip_m_) speed_m_s_.setZero();
        grip_m_ = held;
    }

    falcon::Kinematics legs_;
    std::deque<usb::BusEvent> events_;
    std::deque<Coming> coming_;
    std::vector<std::byte> heard_;
    usb::VendorRequest baud_{};
    falcon::Torque3 shown_{};
    Vec3 grip_m_ = Vec3::Zero(), speed_m_s_ = Vec3::Zero();
    bool open_ = false, dtr_ = false, awake_ = false, real_time_ = false;
    Instant now_ = instant_from_ns(4'294'000'000'000);  // microseconds of 32 bits wrap a second later
};

// Driver, pump and board in sequence on one thread. The caller advances `now`.
class LockstepFalcon final : public HapticDevice {
public:
    explicit LockstepFalcon(const std::string& firmware = {}) {
        auto board = std::make_unique<FalconBoard>();
        board_ = board.get();
        FalconSettings settings;
        settings.thread = false;
        settings.firmware = firmware;
        settings.say = [](const char* /*text*/) {};
        device_ = std::make_unique<Falcon>(settings, std::move(board));
    }

    // Also pushes the grip in, as a person does.
    DeviceInfo open() override {
        const DeviceInfo info = open_only();
        board_->push_through();
        for (int i = 0; i < 50; ++i) cycle({});
        return info;
    }
    DeviceInfo open_only() {
        const DeviceInfo info = device_->open();
        opened_ = true;
        return info;
    }
    IoStatus read(DeviceSample& newest, Instant now) noexcept override {
        if (opened_) {
            if (!matched_) offset_ = board_->now() + std::chrono::milliseconds(1) - now;
            matched_ = true;
            while (board_->now() < now + offset_) pass(now + offset_ - board_->now());
        }
        const IoStatus status = device_->read(newest, board_->now());
        newest.taken_at -= offset_;
        return status;
    }
    IoStatus write(const DeviceCommand& command, Instant /*now*/) noexcept override {
        const IoStatus status = device_->write(command, board_->now());
        if (opened_) device_->pump().round(Duration{0});
        return status;
    }
    void relax() noexcept override { device_->relax(); }

    // One millisecond, one read, one write.
    IoStatus cycle(DeviceCommand given) noexcept {
        pass(std::chrono::milliseconds(1));
        const IoStatus status = device_->read(sample, board_->now());
        given.heartbeat = ++heartbeat_;
        write_status = device_->write(given, board_->now());
        device_->pump().round(Duration{0});
        return status;
    }
    // At most a millisecond without the servo.
    void pass(Duration d) noexcept {
        // In small pieces, as the pump thread works, so that its requests are in step with the servo.
        Duration left = std::min<Duration>(d, std::chrono::milliseconds(1));
        while (left > Duration{0}) {
            const Duration piece = std::min<Duration>(left, std::chrono::microseconds(250));
            board_->advance(piece);
            device_->pump().round(Duration{0});
            left -= piece;
        }
    }
    [[nodiscard]] FalconBoard& board() noexcept { return *board_; }
    [[nodiscard]] falcon::PumpNews news() noexcept {
        falcon::PumpNews n;
        static_cast<void>(device_->pump().read(n));
        return n;
    }

    DeviceSample sample;
    IoStatus write_status = IoStatus::ok;

private:
    FalconBoard* board_ = nullptr;
    std::unique_ptr<Falcon> device_;
    bool opened_ = false, matched_ = false;
    Duration offset_{0};
    std::uint64_t heartbeat_ = 1'000'000;  // the test's own
};

}  // namespace tact::emu
