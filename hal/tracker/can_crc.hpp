// Checksums of the tracker's frames, both with the message's data id in front of its bytes.
//
// CRC-8   SAE J1850: polynomial 0x1D, start 0xFF, inverted at the end; "123456789" gives 0x4B
// CRC-16  CCITT: polynomial 0x1021, start 0xFFFF, no final inversion; "123456789" gives 0x29B1
// Data id sixteen bits, low byte first, before the bytes and never sent: a frame that a gateway or a fault puts
//         under another identifier fails its check (AUTOSAR E2E calls it implicit)
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tact {

namespace crc_detail {

constexpr std::array<std::uint8_t, 256> table8() {
    std::array<std::uint8_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 0x80U) != 0 ? c << 1 ^ 0x1DU : c << 1;
        table[i] = static_cast<std::uint8_t>(c);
    }
    return table;
}

constexpr std::array<std::uint16_t, 256> table16() {
    std::array<std::uint16_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned c = i << 8;
        for (int bit = 0; bit < 8; ++bit) c = (c & 0x8000U) != 0 ? c << 1 ^ 0x1021U : c << 1;
        table[i] = static_cast<std::uint16_t>(c);
    }
    return table;
}

inline constexpr auto kTable8 = table8();
inline constexpr auto kTable16 = table16();

}  // namespace crc_detail

class Crc8 {
public:
    constexpr void add(std::uint8_t byte) noexcept { crc_ = crc_detail::kTable8[crc_ ^ byte]; }
    [[nodiscard]] constexpr std::uint8_t value() const noexcept {
        return static_cast<std::uint8_t>(crc_ ^ 0xFFU);
    }

private:
    std::uint8_t crc_ = 0xFF;
};

class Crc16 {
public:
    constexpr void add(std::uint8_t byte) noexcept {
        crc_ = static_cast<std::uint16_t>(crc_ << 8 ^ crc_detail::kTable16[(crc_ >> 8 ^ byte) & 0xFFU]);
    }
    [[nodiscard]] constexpr std::uint16_t value() const noexcept { return crc_; }

private:
    std::uint16_t crc_ = 0xFFFF;
};

template <class Crc>
[[nodiscard]] constexpr auto crc_of(std::uint16_t data_id, std::span<const std::uint8_t> bytes) noexcept {
    Crc crc;
    crc.add(static_cast<std::uint8_t>(data_id & 0xFFU));
    crc.add(static_cast<std::uint8_t>(data_id >> 8));
    for (const std::uint8_t byte : bytes) crc.add(byte);
    return crc.value();
}

}  // namespace tact
