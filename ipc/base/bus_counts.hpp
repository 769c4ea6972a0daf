// What came over a device's bus since the start of the program, and what of it was wrong. Each number stands at
// 2^32 - 1 once it is there.
//
// Use  goes through DeviceSample, topic and screen as it is; a driver that counts nothing leaves zeros
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ipc/base/rt.hpp"

namespace tact {

struct BusCounts {
    std::uint32_t packets = 0;           // taken
    std::uint32_t checksum = 0;          // refused for it
    std::uint32_t refused = 0;           // for anything else in them
    std::uint32_t repeated = 0;          // or late, or by a clock that stood still
    std::uint32_t lost = 0;              // sequence numbers that never came
    std::uint32_t transfers_failed = 0;  // of the bus itself
    std::uint32_t stalls = 0;
    std::uint32_t reconnects = 0;
    std::uint32_t commands_refused = 0;  // by the device
    std::uint32_t bad_seconds = 0;       // with more than 5 % refused or lost
    bool operator==(const BusCounts&) const = default;

    // Everything but what was taken.
    [[nodiscard]] bool clean() const noexcept TACT_RT {
        BusCounts c = *this;
        c.packets = 0;
        return c == BusCounts{};
    }
};

[[nodiscard]] constexpr std::uint32_t saturated(std::uint64_t n) noexcept TACT_RT {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(n, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace tact
