#include "hal/polhem/reports.hpp"

namespace tact::polhem {

namespace {

using Words = std::array<std::uint16_t, 7>;

std::array<std::byte, kReportBytes> to_bytes(const Words& words) noexcept {
    std::array<std::byte, kReportBytes> out{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        out[2 * i] = static_cast<std::byte>(words[i] & 0xFFU);
        out[2 * i + 1] = static_cast<std::byte>(words[i] >> 8U);
    }
    return out;
}

bool from_bytes(std::span<const std::byte> bytes, Words& words) noexcept {
    if (bytes.size() < kReportBytes || bytes.size() > kReportBytesMax) return false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = static_cast<std::uint16_t>(static_cast<unsigned>(bytes[2 * i]) |
                                              static_cast<unsigned>(bytes[2 * i + 1]) << 8U);
    }
    return true;
}

}  // namespace

std::array<std::byte, kReportBytes> encode(const OutReport& r) noexcept {
    Words w{};
    for (std::size_t i = 0; i < 3; ++i) {
        w[i] = static_cast<std::uint16_t>(r.current_ma[i]);
        w[4 + i] = static_cast<std::uint16_t>(r.attributes[i]);
    }
    w[3] = static_cast<std::uint16_t>(r.command);
    return to_bytes(w);
}

std::array<std::byte, kReportBytes> encode(const InReport& r) noexcept {
    Words w{};
    for (std::size_t i = 0; i < 6; ++i) w[i] = static_cast<std::uint16_t>(r.encoder[i]);
    w[6] = r.info;
    return to_bytes(w);
}

bool decode(std::span<const std::byte> bytes, OutReport& out) noexcept {
    Words w{};
    if (!from_bytes(bytes, w)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        out.current_ma[i] = static_cast<std::int16_t>(w[i]);
        out.attributes[i] = static_cast<std::int16_t>(w[4 + i]);
    }
    out.command = static_cast<std::int16_t>(w[3]);
    return true;
}

bool decode(std::span<const std::byte> bytes, InReport& out) noexcept {
    Words w{};
    if (!from_bytes(bytes, w)) return false;
    for (std::size_t i = 0; i < 6; ++i) out.encoder[i] = static_cast<std::int16_t>(w[i]);
    out.info = w[6];
    return true;
}

const std::array<std::int32_t, 6>& Unwrapped::push(const std::array<std::int16_t, 6>& encoder) noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
        const auto now = static_cast<std::uint16_t>(encoder[i]);
        // Unsigned arithmetic, so that a joint that turns without end wraps instead of overflowing.
        const auto way = static_cast<std::int16_t>(static_cast<std::uint16_t>(now - last_[i]));
        counts_[i] = started_ ? static_cast<std::int32_t>(static_cast<std::uint32_t>(counts_[i]) +
                                                          static_cast<std::uint32_t>(way))
                              : encoder[i];
        last_[i] = now;
    }
    started_ = true;
    return counts_;
}

}  // namespace tact::polhem
