// Reports of Haptikfabriken and Polhem boards: 14 bytes each way, 16-bit integers, little endian.
//
// They have no checksum, sequence number or time: only USB's own checksum protects a report, and the
// receiver must check the plausibility of each value.
//
// Out     currents of three motors in mA, a command (0: currents as given), three words for it
// In      six encoders, which wrap, and a word whose low bits are used as buttons
// Source  the boards' published interface, which does not document the word `info`
// Thread  any; TACT_RT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/base/rt.hpp"

namespace tact::polhem {

inline constexpr std::size_t kReportBytes = 14;
inline constexpr std::size_t kReportBytesMax = 64;  // some boards pad a report to a whole packet

struct OutReport {
    std::array<std::int16_t, 3> current_ma{};
    std::int16_t command = 0;
    std::array<std::int16_t, 3> attributes{};
    bool operator==(const OutReport&) const = default;
};

struct InReport {
    std::array<std::int16_t, 6> encoder{};
    std::uint16_t info = 0;
    bool operator==(const InReport&) const = default;
};

[[nodiscard]] std::array<std::byte, kReportBytes> encode(const OutReport& report) noexcept TACT_RT;
[[nodiscard]] std::array<std::byte, kReportBytes> encode(const InReport& report) noexcept TACT_RT;
// False: wrong size of a report; `out` is unchanged.
[[nodiscard]] bool decode(std::span<const std::byte> bytes, OutReport& out) noexcept TACT_RT;
[[nodiscard]] bool decode(std::span<const std::byte> bytes, InReport& out) noexcept TACT_RT;

// Extends 16-bit encoders to 32-bit counts by the shortest way from the last ones; correct up to half a
// wrap (8 turns of a motor with 4096 counts) between two reports.
class Unwrapped {
public:
    const std::array<std::int32_t, 6>& push(const std::array<std::int16_t, 6>& encoder) noexcept TACT_RT;
    void reset() noexcept TACT_RT { *this = Unwrapped(); }

private:
    bool started_ = false;
    std::array<std::uint16_t, 6> last_{};
    std::array<std::int32_t, 6> counts_{};
};

}  // namespace tact::polhem
