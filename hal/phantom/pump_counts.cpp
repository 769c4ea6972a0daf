#include "hal/phantom/pump_counts.hpp"

namespace tact::phantom {

std::uint64_t PumpCounts::bad() const noexcept {
    std::uint64_t n = repeated + stale + clock + restarted + lost;
    for (const std::uint64_t r : refused) n += r;
    return n;
}

std::string summary(const PumpCounts& c) {
    constexpr std::array<const char*, kPacketFaults> kNames{"",     "size",     "magic",    "version",
                                                            "kind", "checksum", "reserved", "text"};
    std::string refused;
    for (std::size_t i = 1; i < kPacketFaults; ++i) {
        if (c.refused[i] > 0)
            refused +=
                (refused.empty() ? "" : ", ") + std::to_string(c.refused[i]) + " for their " + kNames[i];
    }
    return "asked " + std::to_string(c.asked) + " times, answered " + std::to_string(c.answered) +
           "; states taken " + std::to_string(c.taken) + ", before an answer " + std::to_string(c.early) +
           "; packets refused: " + (refused.empty() ? "none" : refused) + "; transfers failed " +
           std::to_string(c.transfers_failed) + ", stalls " + std::to_string(c.stalls) +
           ", connected again " + std::to_string(c.reconnects);
}

}  // namespace tact::phantom
