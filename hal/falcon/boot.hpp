// Brings a Falcon to the state in which it answers packets: checks whether its firmware runs, and otherwise
// loads the user's file through the boot loader.
//
// asking   an empty request at full speed; firmware that already runs is kept, with its marks found
// hello    DTR restarts the device; at 9600 baud it answers 0A 43 0D with 0A 44 2C 0D
// waking   at 143 kbaud it answers 'A' with 'A'
// writing  62 bytes at a time, echoed by the device; a wrong byte restarts at hello
// Then     asking again, for as long as the firmware takes to start
// Limits   every step has a time limit, all loads together kAttempts; then failed, until start()
// Thread   the pump's; it drives the bus and blocks only for the converter's settings
#pragma once

#include <string>
#include <vector>

#include "hal/falcon/ftdi.hpp"
#include "hal/falcon/packets.hpp"

namespace tact::falcon {

enum class BootState : std::uint8_t { idle, asking, hello, waking, writing, done, failed };
enum class BootFault : std::uint8_t {
    none,
    no_firmware,
    line,
    no_hello,
    no_wake,
    no_echo,
    wrong_echo,
    silent
};
[[nodiscard]] const char* boot_fault_text(BootFault fault) noexcept;

inline constexpr std::size_t kFirmwareBytesMax = std::size_t{128} * 1024;  // the device has 36 KiB of memory

// The user's file; StartupError if it is missing, empty or too large.
[[nodiscard]] std::vector<std::byte> read_firmware(const std::string& path);

class Boot {
public:
    static constexpr Duration kAnswerMax = std::chrono::milliseconds(100);
    static constexpr Duration kEchoMax = std::chrono::seconds(1);
    static constexpr unsigned kAsks = 5, kAsksAfterLoad = 50, kHellos = 30, kAttempts = 3;

    explicit Boot(usb::Bus& bus) : bus_(&bus) {}

    // Sets the firmware; before the first start().
    void give(std::vector<std::byte> firmware) { firmware_ = std::move(firmware); }

    // Call after every connect. anew: loads without asking first, so that the device restarts without its marks.
    void start(Instant now, bool anew = false) noexcept;
    void take(std::span<const std::byte> bytes, Instant now) noexcept;
    void round(Instant now) noexcept;

    [[nodiscard]] BootState state() const noexcept { return state_; }
    [[nodiscard]] BootFault fault() const noexcept { return fault_; }  // of the newest attempt
    [[nodiscard]] bool has_firmware() const noexcept { return !firmware_.empty(); }
    [[nodiscard]] std::size_t written() const noexcept { return echoed_; }
    [[nodiscard]] const Reply& first_reply() const noexcept { return reply_; }

private:
    void enter(BootState state, Instant now) noexcept;
    void ask(Instant now, unsigned tries) noexcept;
    void load(Instant now) noexcept;
    void fail(BootFault fault, Instant now) noexcept;
    bool set(std::span<const usb::VendorRequest> line, Instant now) noexcept;
    void say(std::span<const std::byte> bytes, Instant now) noexcept;
    void echo(std::byte byte, Instant now) noexcept;

    usb::Bus* bus_;
    std::vector<std::byte> firmware_;
    ReplyStream stream_;
    Reply reply_;
    BootState state_ = BootState::idle;
    BootFault fault_ = BootFault::none;
    Instant since_{};
    unsigned tries_ = 0, attempts_ = 0;
    bool said_ = false, loaded_ = false;
    std::uint32_t heard_ = 0;  // the last four bytes
    std::size_t chunk_ = 0, echoed_ = 0;
};

}  // namespace tact::falcon
