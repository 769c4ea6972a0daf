// The USB descriptors of an arm's board for FunctionFS: the interface of hal/phantom/PROTOCOL.md.
//
// Bytes    for a FunctionFS ep0, little endian: descriptors of full and high speed (version 2), then strings.
//          The protocol refuses full speed, but the kernel requires its description.
// Thread   any; pure
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/probe/known_devices.hpp"

namespace tact::emu {

inline constexpr std::uint8_t kInterfaceClass = probe::kPhantomInterface >> 16U,
                              kInterfaceSubclass = probe::kPhantomInterface >> 8U & 0xFFU,
                              kInterfaceProtocol = probe::kPhantomInterface & 0xFFU;
inline constexpr std::uint8_t kEndpointIn = 0x81, kEndpointOut = 0x02;
inline constexpr std::uint16_t kPacketBytesMax = 64;

// Period of the endpoints for a rate of the states: bInterval at high speed, in 2^(n-1) of 125 us.
[[nodiscard]] std::uint8_t interval_of(std::uint16_t rate_hz) noexcept;

[[nodiscard]] std::vector<std::byte> ffs_descriptors(std::uint16_t rate_hz);
[[nodiscard]] std::vector<std::byte> ffs_strings();

}  // namespace tact::emu
