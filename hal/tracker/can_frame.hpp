// One CAN or CAN FD frame in memory, without kernel headers; shared by decoder, tests and emulators.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tact {

enum class CanKind : std::uint8_t {
    classic,    // at most 8 bytes, 11 bit identifier
    fd,         // at most 64 bytes, 11 bit identifier
    error,      // from the controller or the kernel, read by can_reader.cpp
    malformed,  // extended identifier, remote request, or an impossible length
};

struct CanFrame {
    std::uint32_t id = 0;  // 11 bits; for an error frame: its classes
    CanKind kind = CanKind::malformed;
    std::uint8_t length = 0;
    std::array<std::uint8_t, 64> data{};

    [[nodiscard]] std::span<const std::uint8_t> payload() const noexcept {
        return {data.data(), length < data.size() ? length : data.size()};
    }
};

}  // namespace tact
