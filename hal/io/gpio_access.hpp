// The lines of a GPIO chip through libgpiod, whose two generations have no call in common: this header
// hides the difference. gpio_access_v1.cpp is for 1.6 (Debian 12), gpio_access_v2.cpp for 2.x (Debian 13);
// CMake selects the right one.
//
// Values   bit i belongs to the i-th line of the request, 1 is active
// Errors   GpioRefusal at the request; false afterwards. set() may return true although the adapter was
//          unplugged: only a read of the inputs and a check of the device node detect that
// Thread   one at a time
#pragma once

#include <charconv>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact {

enum class GpioBias : std::uint8_t { as_is, up, down };

struct GpioLine {
    std::string line;  // number or name
    bool output = false;
    bool active_low = false;
    bool edges = false;  // of an input: wait() reports them
    GpioBias bias = GpioBias::as_is;
};

struct GpioChip {
    std::string path, name, label;
    unsigned lines = 0;
};

struct GpioRefusal {
    std::string line{};    // empty: the chip itself
    int error = 0;         // errno; 0: no such line
    std::string detail{};  // for people
};

// "3" is a number, "E_STOP" a name.
[[nodiscard]] inline bool gpio_line_number(const std::string& line, unsigned& number) noexcept {
    const char* const end = line.data() + line.size();
    const auto [stopped, error] = std::from_chars(line.data(), end, number);
    return !line.empty() && error == std::errc{} && stopped == end;
}

class GpioAccess {
public:
    static constexpr std::size_t kLinesMax = 16;

    // Outputs start inactive. Throws GpioRefusal.
    GpioAccess(const std::string& path, std::span<const GpioLine> lines);
    ~GpioAccess();
    GpioAccess(const GpioAccess&) = delete;
    GpioAccess& operator=(const GpioAccess&) = delete;

    [[nodiscard]] bool get(std::uint32_t& active) noexcept;  // of the inputs
    [[nodiscard]] bool set(std::size_t i, bool active) noexcept;
    // Waits for an edge, at most `longest`; adds the lines with edges to `touched`. False: the chip is gone.
    [[nodiscard]] bool wait(Duration longest, std::uint32_t& touched) noexcept;

    // The chip of this device node; false with errno in `error`.
    static bool describe(const std::string& path, GpioChip& chip, int& error);

private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace tact
