// Counts system management interrupts of a processor core: interrupts of the firmware that no kernel can delay or
// detect.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tact::launch {

struct SmiReading {
    std::optional<std::uint64_t> count;  // since power-on, 32 bits
    std::string why_not;
};

// MSR_SMI_COUNT (0x34) of Intel processors, through /dev/cpu/N/msr below the root.
[[nodiscard]] SmiReading read_smi_count(int core, const std::filesystem::path& root = "/");
// Difference of two readings, across an overflow.
[[nodiscard]] std::uint64_t smi_between(std::uint64_t before, std::uint64_t after);

}  // namespace tact::launch
