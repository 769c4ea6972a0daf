#include "hal/phantom/pump_counts.hpp"

namespace tact::phantom {

std::uint64_t PumpCounts::bad() const noexcept {
    std::uint64_t n = repeated + stale + clock + restarted + lost;
    for (const std::uint64_t r : refused) n += r;
    return n;
}

BusCounts PumpCounts::shown() const noexcept {
    const std::uint64_t checksum = refused[static_cast<std::size_t>(PacketFault::checksum)];
    std::uint64_t others = 0;
    for (const std::uint64_t r : refused) others += r;
    BusCounts b{};
    b.packets = saturated(taken);
    b.checksum = saturated(checksum);
    b.refused = saturated(others - checksum);
    b.repeated = saturated(repeated + stale + clock);
    b.lost = saturated(lost);
    b.transfers_failed = saturated(transfers_failed);
    b.stalls = saturated(stalls);
    b.reconnects = saturated(reconnects);
    b.commands_refused = saturated(refused_by_board);
    b.bad_seconds = saturated(bad_seconds);
    return b;
}

std::string summary(const PumpCounts& c) {
    constexpr std::array<const char*, kPacketFaults> kNames{"",     "size",     "magic",    "version",
                                                            "kind", "checksum", "reserved", "text"};
    std::string refused;
    for (std::size_t i = 1; i < kPacketFaults; ++i) {
        if (c.refused[i] > 0)
            refused += (refused.empty() ? "" : ", ") + std::to_string(c.refused[i]) + " " + kNames[i];
    }
    return "queries " + std::to_string(c.asked) + ", answers " + std::to_string(c.answered) +
           "; states accepted " + std::to_string(c.taken) + ", before the first answer " +
           std::to_string(c.early) + "; packets refused: " + (refused.empty() ? "none" : refused) +
           "; transfers failed " + std::to_string(c.transfers_failed) + ", stalls " +
           std::to_string(c.stalls) + ", connected again " + std::to_string(c.reconnects);
}

}  // namespace tact::phantom
