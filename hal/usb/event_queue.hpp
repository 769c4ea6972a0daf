// Events of a bus that its pump has not fetched yet. When full, it drops the oldest: an old state has no
// value.
//
// Thread  the pump's
#pragma once

#include <algorithm>

#include "hal/usb/bus.hpp"

namespace tact::usb {

template <std::size_t N>
class EventQueue {
public:
    void push(BusEventKind kind, Instant at, std::span<const std::byte> bytes = {}) noexcept {
        if (count_ == N) {
            first_ = (first_ + 1) % N;
            --count_;
        }
        BusEvent& e = events_[(first_ + count_++) % N];
        e.kind = kind;
        e.at = at;
        e.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), e.bytes.size() + 1));
        std::copy_n(bytes.begin(), std::min(bytes.size(), e.bytes.size()), e.bytes.begin());
    }
    // Moves the oldest events out; returns their number.
    std::size_t fetch(std::span<BusEvent> into) noexcept {
        const std::size_t n = std::min(count_, into.size());
        for (std::size_t i = 0; i < n; ++i) into[i] = events_[(first_ + i) % N];
        first_ = (first_ + n) % N;
        count_ -= n;
        return n;
    }
    void clear() noexcept { first_ = count_ = 0; }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

private:
    std::array<BusEvent, N> events_{};
    std::size_t first_ = 0, count_ = 0;
};

}  // namespace tact::usb
