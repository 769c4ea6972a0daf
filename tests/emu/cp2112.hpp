// An emulated CP2112 USB adapter: eight GPIO lines for which the real kernel driver (hid-cp2112) makes a gpiochip.
//
// Cp2112         the chip's answers, without a kernel; report numbers and layouts: Silicon Labs AN495, sections
//                5.2 to 5.6, as the kernel's drivers/hid/hid-cp2112.c uses them
// EmulatedLines  the chip behind /dev/uhid, with a thread that answers; levels set by script, from any thread
// Fails by       StartupError in plug(): no /dev/uhid, no rights
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace tact::emu {

class Cp2112 {
public:
    static constexpr unsigned kLines = 8;

    // Bytes of a feature report, report number first; an unknown report is its number and a zero.
    [[nodiscard]] std::vector<std::uint8_t> get_report(std::uint8_t number) const;
    // Applies a feature report, report number first. A report that is too short changes nothing.
    void set_report(std::span<const std::uint8_t> bytes);

    void set(unsigned line, bool level);                // external level; visible while the line is an input
    void follow(unsigned input, unsigned output);       // connects the input to the output
    [[nodiscard]] bool level(unsigned line) const;      // at the pin
    [[nodiscard]] bool is_output(unsigned line) const;  // as configured by the host
    [[nodiscard]] std::uint64_t edges(unsigned line) const { return edges_.at(line); }  // of outputs

private:
    [[nodiscard]] std::uint8_t pins() const;

    std::uint8_t outputs_ = 0;  // bit 1: output
    std::uint8_t latch_ = 0;    // written by the host
    std::uint8_t outside_ = 0;
    std::array<int, kLines> follows_{-1, -1, -1, -1, -1, -1, -1, -1};
    std::array<std::uint64_t, kLines> edges_{};
};

class EmulatedLines {
public:
    EmulatedLines() = default;
    ~EmulatedLines() { unplug(); }
    EmulatedLines(const EmulatedLines&) = delete;
    EmulatedLines& operator=(const EmulatedLines&) = delete;

    void plug();    // all lines start as inputs; throws StartupError
    void unplug();  // may be called twice

    void set(unsigned line, bool level);
    void follow(unsigned input, unsigned output);
    // Sets a callback on the serving thread for outputs changed by the host. Call it before plug().
    void when_driven(std::function<void(unsigned line, bool level)> tell) { tell_ = std::move(tell); }
    [[nodiscard]] bool level(unsigned line);
    [[nodiscard]] std::uint64_t edges(unsigned line);

private:
    void serve();

    std::mutex mutex_;
    Cp2112 chip_;
    std::function<void(unsigned, bool)> tell_;
    int fd_ = -1, leave_fd_ = -1;
    std::thread thread_;
};

}  // namespace tact::emu
