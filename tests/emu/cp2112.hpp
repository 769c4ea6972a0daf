// A CP2112 USB adapter out of nothing: eight GPIO lines whose real kernel driver (hid-cp2112) makes a gpiochip.
//
// Cp2112         what the chip answers, without a kernel; report numbers and layouts: Silicon Labs AN495, sections
//                5.2 to 5.6, as the kernel's drivers/hid/hid-cp2112.c uses them
// EmulatedLines  the chip behind /dev/uhid, with a thread that answers; levels by script, from any thread
// Fails by       StartupError at plug(): no /dev/uhid, no rights
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

    // Bytes of a feature report, its number first; what is unknown is a number and a zero.
    [[nodiscard]] std::vector<std::uint8_t> get_report(std::uint8_t number) const;
    // A feature report as it was sent, its number first. What is too short changes nothing.
    void set_report(std::span<const std::uint8_t> bytes);

    void set(unsigned line, bool level);                // from outside; seen while the line is an input
    void follow(unsigned input, unsigned output);       // wired together
    [[nodiscard]] bool level(unsigned line) const;      // at the pin
    [[nodiscard]] bool is_output(unsigned line) const;  // as the host made it
    [[nodiscard]] std::uint64_t edges(unsigned line) const { return edges_.at(line); }  // of outputs

private:
    [[nodiscard]] std::uint8_t pins() const;

    std::uint8_t outputs_ = 0;  // 1: output
    std::uint8_t latch_ = 0;    // what the host wrote
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

    void plug();    // the chip begins with all lines as inputs; throws StartupError
    void unplug();  // twice is as good as once

    void set(unsigned line, bool level);
    void follow(unsigned input, unsigned output);
    // Called on the serving thread when the host has changed an output. Before plug().
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
