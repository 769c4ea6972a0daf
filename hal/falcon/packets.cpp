#include "hal/falcon/packets.hpp"

namespace tact::falcon {

namespace {

constexpr std::byte kHead{'<'}, kTail{'>'};
constexpr unsigned kBase = 'A';
constexpr std::size_t kBitsAt = 13, kUnknownAt = 14;

// The bits of a byte from kBase to kBase + most; false for any other byte.
bool value(std::byte byte, unsigned most, unsigned& out) noexcept {
    const auto b = static_cast<unsigned>(byte);
    if (b < kBase || b - kBase > most) return false;
    out = b - kBase;
    return true;
}

std::array<std::byte, kPacketBytes> encode(const std::array<std::int16_t, 3>& values,
                                           unsigned bits) noexcept {
    std::array<std::byte, kPacketBytes> out{};
    out.fill(std::byte{kBase});
    out.front() = kHead;
    out.back() = kTail;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto v = static_cast<std::uint16_t>(values[i]);
        for (std::size_t k = 0; k < 4; ++k)
            out[1 + 4 * i + k] = static_cast<std::byte>(kBase + ((v >> (4U * k)) & 0xFU));
    }
    out[kBitsAt] = static_cast<std::byte>(kBase + bits);
    return out;
}

PacketFault decode(std::span<const std::byte> bytes, std::array<std::int16_t, 3>& values,
                   unsigned& bits) noexcept {
    if (bytes.size() != kPacketBytes || bytes.front() != kHead || bytes.back() != kTail)
        return PacketFault::frame;
    for (std::size_t i = 0; i < 3; ++i) {
        unsigned v = 0, digit = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (!value(bytes[1 + 4 * i + k], 0xF, digit)) return PacketFault::digit;
            v |= digit << (4U * k);
        }
        values[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(v));
    }
    return value(bytes[kBitsAt], 0x7F, bits) ? PacketFault::none : PacketFault::bits;
}

}  // namespace

std::array<std::byte, kPacketBytes> encode(const Request& request) noexcept {
    return encode(request.torque, (request.leds & unsigned{led::kAll}) | (request.homing ? 1U : 0U));
}

std::array<std::byte, kPacketBytes> encode(const Reply& reply) noexcept {
    return encode(reply.counts, (reply.buttons & 0xFU) | (reply.homed & unsigned{kHomedAll}) << 4U);
}

PacketFault decode(std::span<const std::byte> bytes, Request& out) noexcept {
    Request r;
    unsigned bits = 0;
    const PacketFault fault = decode(bytes, r.torque, bits);
    if (fault != PacketFault::none) return fault;
    if (bits > 0xF) return PacketFault::bits;
    r.leds = static_cast<std::uint8_t>(bits & led::kAll);
    r.homing = (bits & 1U) != 0;
    out = r;
    return PacketFault::none;
}

PacketFault decode(std::span<const std::byte> bytes, Reply& out) noexcept {
    Reply r;
    unsigned bits = 0;
    const PacketFault fault = decode(bytes, r.counts, bits);
    if (fault != PacketFault::none) return fault;
    r.buttons = static_cast<std::uint8_t>(bits & 0xFU);
    r.homed = static_cast<std::uint8_t>(bits >> 4U & kHomedAll);
    out = r;
    return PacketFault::none;
}

// Neither '<' nor '>' is a digit, so inside a packet both mean that it was cut; '<' starts a new packet.
bool ReplyStream::push(std::byte byte, Reply& out) noexcept {
    const bool inside = size_ > 0;
    const bool cut = inside && size_ < kUnknownAt && (byte == kHead || byte == kTail);
    if (cut) {
        ++counts_.refused[static_cast<std::size_t>(PacketFault::frame)];
        size_ = 0;
        if (byte == kTail) return false;
    }
    if (size_ == 0 && byte != kHead) {
        ++counts_.skipped;
        return false;
    }
    bytes_[size_++] = byte;
    if (size_ < kPacketBytes) return false;
    size_ = 0;
    const PacketFault fault = decode(bytes_, out);
    if (fault == PacketFault::none) {
        ++counts_.good;
        return true;
    }
    ++counts_.refused[static_cast<std::size_t>(fault)];
    if (fault == PacketFault::frame && byte == kHead) bytes_[size_++] = byte;
    return false;
}

}  // namespace tact::falcon
