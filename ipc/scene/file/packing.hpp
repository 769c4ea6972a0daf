// Checksums and packed bytes of files.
//
// Thread   any but the servo thread
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tact {

// CRC-32, continued from that of the bytes before.
[[nodiscard]] std::uint32_t crc_of(const void* data, std::size_t size, std::uint32_t before = 0);
// Appends the bytes, packed fast by zlib; returns how many that are.
std::size_t pack(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& to);
// The most that so many bytes can be when packed.
[[nodiscard]] std::uint64_t packed_most(std::uint64_t bytes);
// False: the packed bytes are not exactly those of to.size().
[[nodiscard]] bool unpack(std::span<const std::uint8_t> packed, std::span<std::uint8_t> to);

}  // namespace tact
