// An emulated USB bus whose time advances only while a driver waits; the target defines the device's data.
#pragma once

#include <algorithm>
#include <deque>

#include "hal/usb/bus.hpp"

namespace tact::fuzz {

class FuzzUsbBus : public usb::Bus {
public:
    usb::BusFinding open(const std::string& /*serial*/) override { return {usb::BusFault::none, "F", {}}; }
    void close() noexcept override { events.clear(); }
    std::size_t wait(std::span<usb::BusEvent> out, Duration patience) noexcept override {
        if (events.empty()) time += patience;
        std::size_t n = 0;
        for (; n < out.size() && !events.empty(); ++n) {
            out[n] = events.front();
            events.pop_front();
        }
        return n;
    }
    bool clear_stall() noexcept override { return true; }
    bool control(const usb::VendorRequest& /*request*/) noexcept override { return true; }
    Instant now() noexcept override { return time; }

    // At most 64 events, like the emulated bus of the tests.
    void push(usb::BusEventKind kind, std::span<const std::byte> bytes = {}) {
        usb::BusEvent e;
        e.kind = kind;
        e.at = time;
        e.size = static_cast<std::uint8_t>(bytes.size() > 64 ? 65 : bytes.size());
        std::copy_n(bytes.begin(), std::min<std::size_t>(bytes.size(), 64), e.bytes.begin());
        if (events.size() < 64) events.push_back(e);
    }

    std::deque<usb::BusEvent> events;
    Instant time = instant_from_ns(1'000'000'000);
};

}  // namespace tact::fuzz
