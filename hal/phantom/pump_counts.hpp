// Packets received over the bus since the start of the program, and the refused ones.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/phantom/packets.hpp"
#include "ipc/base/bus_counts.hpp"

namespace tact::phantom {

struct PumpCounts {
    std::array<std::uint64_t, kPacketFaults> refused{};  // states and answers, by PacketFault
    std::uint64_t taken = 0, repeated = 0, stale = 0, clock = 0, restarted = 0, lost = 0;
    std::uint64_t transfers_failed = 0, stalls = 0, reconnects = 0;
    std::uint64_t sent = 0, asked = 0, answered = 0;  // commands; queries and infos
    std::uint64_t early = 0;                          // states before the first answer of a connection
    std::uint64_t refused_by_board = 0;               // commands
    std::uint64_t bad_seconds = 0;                    // with more than 5 % refused or lost
    [[nodiscard]] std::uint64_t bad() const noexcept;
    // The same counters for topic and display.
    [[nodiscard]] BusCounts shown() const noexcept TACT_RT;
};

// Text for people: received and refused packets. Not for the servo thread.
[[nodiscard]] std::string summary(const PumpCounts& counts);

}  // namespace tact::phantom
