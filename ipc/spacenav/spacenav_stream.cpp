#include "ipc/spacenav/spacenav_stream.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tact {
namespace {

enum SpacenavPacket : std::int32_t {
    kMotion,
    kPress,
    kRelease,
    kDevice,
    kConfiguration,
    kRawAxis,
    kRawButton
};
constexpr std::int32_t kRequest = 0x7faa0000, kRequestBits = 0x7fff0000;
constexpr std::int32_t kDeviceType = 0x2005;
constexpr std::int32_t kTypeMost = 0xffff;

}  // namespace

SpacenavStream::Packet SpacenavStream::device_type_request() {
    return {kRequest | kDeviceType, 0, 0, 0, 0, 0, 0, 0};
}

void SpacenavStream::add(std::span<const std::byte> bytes) {
    while (!bytes.empty() && !lost()) {
        const std::size_t n = std::min(bytes.size(), kPacketBytes - have_);
        std::copy_n(bytes.begin(), n, part_.begin() + static_cast<std::ptrdiff_t>(have_));
        bytes = bytes.subspan(n);
        have_ += n;
        if (have_ < kPacketBytes) return;
        have_ = 0;
        Packet p{};
        std::memcpy(p.data(), part_.data(), kPacketBytes);
        packet(p);
    }
}

void SpacenavStream::packet(const Packet& p) {
    if (accept(p)) {
        ++state_.events;
        bad_in_row_ = 0;
        return;
    }
    ++state_.refused;
    if (++bad_in_row_ >= kBadMost) release();
}

void SpacenavStream::release() {
    state_.axes = {};
    state_.buttons = 0;
}

bool SpacenavStream::accept(const Packet& p) {
    const std::int32_t what = p[0];
    switch (what) {
        case kMotion: {
            for (std::size_t i = 0; i < 6; ++i)
                if (p[i + 1] > SpacenavState::kAxisMost || p[i + 1] < -SpacenavState::kAxisMost) return false;
            std::copy_n(p.begin() + 1, 6, state_.axes.begin());
            state_.device = SpacenavDevice::present;  // it moved
            return true;
        }
        case kPress:
        case kRelease: {
            if (p[1] < 0) return false;
            if (static_cast<std::uint32_t>(p[1]) >= SpacenavState::kButtons) return true;
            const std::uint32_t bit = 1U << static_cast<std::uint32_t>(p[1]);
            if (what == kPress) {
                state_.buttons |= bit;
                state_.pressed |= bit;
            } else {
                state_.buttons &= ~bit;
            }
            state_.device = SpacenavDevice::present;
            return true;
        }
        case kDevice:
            if (p[1] != 0 && p[1] != 1) return false;
            // One of several may have left, so what was held is released in any case.
            release();
            device_changed_ = true;
            return true;
        case kConfiguration:
        case kRawAxis:
        case kRawButton:
            return true;
        default:
            break;
    }
    if ((what & kRequestBits) != kRequest) return false;
    if ((what & ~kRequestBits) != kDeviceType) return true;
    const bool there = p[7] == 0;
    if (there && (p[1] < 0 || p[1] > kTypeMost)) return false;
    state_.device = there ? SpacenavDevice::present : SpacenavDevice::absent;
    state_.type = there ? p[1] : 0;
    if (!there) release();
    return true;
}

bool SpacenavStream::take_device_changed() { return std::exchange(device_changed_, false); }
std::uint32_t SpacenavStream::take_pressed() { return std::exchange(state_.pressed, 0U); }

}  // namespace tact
