// Packets received over a device's bus since the start of the program, and its errors. Each counter
// saturates at 2^32 - 1.
//
// Use  goes through DeviceSample, topic and display unchanged; a driver without counters leaves zeros
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ipc/base/rt.hpp"

namespace tact {

struct BusCounts {
    std::uint32_t packets = 0;           // accepted
    std::uint32_t checksum = 0;          // refused for their checksum
    std::uint32_t refused = 0;           // refused for another reason
    std::uint32_t repeated = 0;          // or late, or with a clock that did not advance
    std::uint32_t lost = 0;              // sequence numbers that never arrived
    std::uint32_t transfers_failed = 0;  // of the bus itself
    std::uint32_t stalls = 0;
    std::uint32_t reconnects = 0;
    std::uint32_t commands_refused = 0;  // by the device
    std::uint32_t bad_seconds = 0;       // with more than 5 % refused or lost
    bool operator==(const BusCounts&) const = default;

    // True if all counters except `packets` are zero.
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
