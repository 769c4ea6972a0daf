#include "hal/falcon/boot.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "ipc/base/error.hpp"

namespace tact::falcon {

namespace {

constexpr std::array kHello{std::byte{0x0A}, std::byte{0x43}, std::byte{0x0D}};
constexpr std::uint32_t kHelloBack = 0x0A442C0D;
constexpr std::array kWake{std::byte{0x41}};

}  // namespace

const char* boot_fault_text(BootFault fault) noexcept {
    switch (fault) {
        case BootFault::none:
            return "nothing";
        case BootFault::no_firmware:
            return "the device runs no firmware, and none is configured";
        case BootFault::line:
            return "the serial converter does not accept its settings";
        case BootFault::no_hello:
            return "the boot loader does not answer";
        case BootFault::no_wake:
            return "the boot loader does not switch to full speed";
        case BootFault::no_echo:
            return "the boot loader stopped in the middle of the firmware";
        case BootFault::wrong_echo:
            return "the boot loader echoes wrong firmware bytes";
        case BootFault::silent:
            return "the device accepted the firmware, but the firmware does not answer";
    }
    return "unknown";
}

std::vector<std::byte> read_firmware(const std::string& path) {
    const std::string what = "reading the Falcon's firmware " + path;
    const std::string fix = "set device.firmware to the file that came with the device's own software";
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw StartupError(what, std::strerror(errno != 0 ? errno : ENOENT), fix);
    std::vector<char> bytes(kFirmwareBytesMax + 1);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (file.bad() || file.gcount() == 0) throw StartupError(what, "the file is empty", fix);
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > kFirmwareBytesMax)
        throw StartupError(what, "the file has more than " + std::to_string(kFirmwareBytesMax) + " bytes",
                           fix);
    std::vector<std::byte> out(bytes.size());
    std::transform(bytes.begin(), bytes.end(), out.begin(), [](char c) { return static_cast<std::byte>(c); });
    return out;
}

void Boot::start(Instant now, bool anew) noexcept {
    attempts_ = 0;
    fault_ = BootFault::none;
    loaded_ = false;
    if (anew && has_firmware()) return load(now);
    ask(now, kAsks);
}

void Boot::enter(BootState state, Instant now) noexcept {
    state_ = state;
    since_ = now;
    said_ = false;
    heard_ = 0;
}

bool Boot::set(std::span<const usb::VendorRequest> line, Instant now) noexcept {
    const bool taken = std::all_of(line.begin(), line.end(),
                                   [this](const usb::VendorRequest& r) { return bus_->control(r); });
    if (!taken) fail(BootFault::line, now);
    return taken;
}

void Boot::ask(Instant now, unsigned tries) noexcept {
    if (!set(ftdi::kRunLine, now)) return;
    stream_.reset();
    enter(BootState::asking, now);
    tries_ = tries;
}

void Boot::load(Instant now) noexcept {
    ++attempts_;
    if (!set(ftdi::kBootLine, now)) return;
    enter(BootState::hello, now);
    tries_ = kHellos;
}

// The converter's settings are not retried: a converter that refuses one is gone or of another kind.
void Boot::fail(BootFault fault, Instant now) noexcept {
    fault_ = fault;
    const bool over = fault == BootFault::line || fault == BootFault::no_firmware || attempts_ >= kAttempts;
    if (over) return enter(BootState::failed, now);
    loaded_ = false;
    load(now);
}

void Boot::say(std::span<const std::byte> bytes, Instant now) noexcept {
    if (!bus_->send(bytes)) return;  // the previous message is still being sent; retry in the next round
    said_ = true;
    since_ = now;
}

void Boot::round(Instant now) noexcept {
    switch (state_) {
        case BootState::asking:
            if (!said_) return say(encode(Request{{}, led::kRed, true}), now);
            if (now - since_ < kAnswerMax) return;
            said_ = false;
            if (--tries_ > 0) return;
            if (!has_firmware()) return fail(BootFault::no_firmware, now);
            return loaded_ ? fail(BootFault::silent, now) : load(now);
        case BootState::hello:
            if (!said_) return say(kHello, now);
            if (now - since_ < kAnswerMax) return;
            said_ = false;
            if (--tries_ == 0) fail(BootFault::no_hello, now);
            return;
        case BootState::waking:
            if (!said_) return say(kWake, now);
            if (now - since_ >= kEchoMax) fail(BootFault::no_wake, now);
            return;
        case BootState::writing:
            if (!said_) {
                chunk_ = std::min(ftdi::kPieceBytes, firmware_.size() - echoed_);
                return say(std::span(firmware_).subspan(echoed_, chunk_), now);
            }
            if (now - since_ >= kEchoMax) fail(BootFault::no_echo, now);
            return;
        default:
            return;
    }
}

void Boot::echo(std::byte byte, Instant now) noexcept {
    if (!said_ || byte != firmware_[echoed_]) return fail(BootFault::wrong_echo, now);
    ++echoed_;
    if (--chunk_ > 0) return;
    said_ = false;
    since_ = now;
    if (echoed_ < firmware_.size()) return;
    loaded_ = true;
    ask(now, kAsksAfterLoad);
}

void Boot::take(std::span<const std::byte> bytes, Instant now) noexcept {
    for (const std::byte byte : bytes) {
        heard_ = heard_ << 8U | static_cast<std::uint32_t>(byte);
        switch (state_) {
            case BootState::asking:
                if (stream_.push(byte, reply_)) return enter(BootState::done, now);
                break;
            case BootState::hello:
                if (heard_ != kHelloBack) break;
                if (set(ftdi::kLoadLine, now)) enter(BootState::waking, now);
                return;  // bytes after the reply have the wrong speed
            case BootState::waking:
                if (!said_ || byte != kWake[0]) break;
                echoed_ = 0;
                return enter(BootState::writing, now);
            case BootState::writing:
                echo(byte, now);
                if (state_ != BootState::writing) return;
                break;
            default:
                return;
        }
    }
}

}  // namespace tact::falcon
