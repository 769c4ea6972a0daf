#include "hal/phantom/amplifier.hpp"

#include <algorithm>

namespace tact::phantom {

void Amplifier::drop(AmplifierState to) noexcept {
    state_ = to;
    current_ma_.fill(0);
}

void Amplifier::tick(std::uint32_t now_us, std::uint16_t causes) noexcept {
    causes_ = static_cast<std::uint16_t>(causes & status::kFaults);
    latched_ = static_cast<std::uint16_t>(latched_ | causes_);
    if (latched_ != 0) return drop(AmplifierState::fault);
    if (state_ == AmplifierState::on && now_us - fed_us_ >= watchdog_us_) drop(AmplifierState::tripped);
}

bool Amplifier::receive(std::span<const std::byte> bytes, std::uint32_t now_us) noexcept {
    Command c;
    // Refuse a command for another boot before its sequence counts.
    const bool good = decode(bytes, c) == PacketFault::none && c.boot == boot_;
    if (!good || gate_.check(c.boot, c.sequence) != Order::taken) {
        ++refused_;
        return false;
    }
    tick(now_us, causes_);  // a late command does not cancel a watchdog trip
    seen_ = c.sequence;
    if (c.heartbeat != heartbeat_) {
        heartbeat_ = c.heartbeat;
        fed_us_ = now_us;
    }
    const bool edge = c.enable && !enable_before_;
    enable_before_ = c.enable;
    if (!c.enable) {
        latched_ = causes_;
        drop(latched_ != 0 ? AmplifierState::fault : AmplifierState::off);
        return true;
    }
    if (edge && latched_ == 0) {
        state_ = AmplifierState::on;
        fed_us_ = now_us;
    }
    if (state_ != AmplifierState::on) return true;
    for (std::size_t i = 0; i < 6; ++i) {
        const int max = std::min<int>(max_ma_[i], 32767);
        current_ma_[i] = static_cast<std::int16_t>(std::clamp<int>(c.current_ma[i], -max, max));
    }
    return true;
}

std::uint16_t Amplifier::status() const noexcept {
    std::uint16_t s = latched_;
    if (state_ == AmplifierState::on) s |= status::kAmplifierOn;
    if (state_ == AmplifierState::tripped) s |= status::kWatchdogTripped;
    return s;
}

}  // namespace tact::phantom
