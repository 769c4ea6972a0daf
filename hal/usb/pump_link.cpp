#include "hal/usb/pump_link.hpp"

namespace tact::usb {

BusFinding PumpLink::open() {
    BusFinding found = bus_.open(serial_);
    if (found.fault == BusFault::none && serial_.empty()) serial_ = found.serial;
    return found;
}

bool PumpLink::reopen(Instant now) noexcept {
    if (now < retry_at_) return false;
    retry_at_ = now + kReopenEvery;
    try {
        return bus_.open(serial_).fault == BusFault::none;
    } catch (...) {
        return false;  // out of memory for a moment: retried later
    }
}

void PumpLink::lose(Instant now) noexcept {
    bus_.close();
    retry_at_ = now + kReopenEvery;
}

bool BadSeconds::over(Instant now, std::uint64_t bad, std::uint64_t taken) noexcept {
    if (now - began_at_ < std::chrono::seconds(1)) return false;
    began_at_ = now;
    const std::uint64_t newly_bad = bad - std::exchange(bad_, bad);
    const std::uint64_t newly_taken = taken - std::exchange(taken_, taken);
    last_bad_ = newly_bad * 20 > newly_bad + newly_taken;
    return true;
}

}  // namespace tact::usb
