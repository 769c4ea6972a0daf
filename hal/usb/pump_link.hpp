// The bus of a pump: opens it by serial number, searches again after a loss, and passes its events on in
// bounded batches; and the fraction of bad packets in each second.
//
// Thread  the pump's; open() at start-up
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "hal/usb/bus.hpp"

namespace tact::usb {

class PumpLink {
public:
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(200);
    static constexpr std::size_t kBatch = 16, kBatchesMax = 4;

    PumpLink(Bus& bus, std::string serial) : bus_(bus), serial_(std::move(serial)) {}

    [[nodiscard]] Bus& bus() const noexcept { return bus_; }
    [[nodiscard]] const std::string& serial() const noexcept { return serial_; }

    // One attempt. After the first success, the serial number is that of the device found.
    [[nodiscard]] BusFinding open();
    // For a lost link: one attempt every kReopenEvery. True: open again.
    [[nodiscard]] bool reopen(Instant now) noexcept;
    void lose(Instant now) noexcept;

    // Passes on the events of `patience`, at most kBatch times kBatchesMax. True: an endpoint stalled.
    template <class Take>
    [[nodiscard]] bool drain(Duration patience, Take&& take) noexcept {
        bool stalled = false;
        for (std::size_t n = 0; n < kBatchesMax; ++n) {
            const std::size_t count =
                std::min(bus_.wait(events_, n == 0 ? patience : Duration{0}), events_.size());
            for (const BusEvent& event : std::span(events_).first(count)) {
                stalled = stalled || event.kind == BusEventKind::stalled;
                take(event);
            }
            if (count < events_.size()) break;
        }
        return stalled;
    }

private:
    Bus& bus_;
    std::string serial_;
    Instant retry_at_{};
    std::array<BusEvent, kBatch> events_{};
};

// Packets refused or lost, second by second.
class BadSeconds {
public:
    // Takes the counts since the start. True once a second: bad() then describes the past second.
    [[nodiscard]] bool over(Instant now, std::uint64_t bad, std::uint64_t taken) noexcept;
    // More than 5 % of the packets were bad.
    [[nodiscard]] bool bad() const noexcept { return last_bad_; }

private:
    Instant began_at_{};
    std::uint64_t taken_ = 0, bad_ = 0;
    bool last_bad_ = false;
};

}  // namespace tact::usb
