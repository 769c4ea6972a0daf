// Where the reports come from and go to: the kernel's hidraw, or what a test makes up.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "hal/usb/bus.hpp"

namespace tact::polhem {

inline constexpr int kPortGone = -1;  // unplugged, or it fails: nothing more until open()

class HidPort {
public:
    virtual ~HidPort() = default;
    // Empty serial: the only board there is. Anything but `none` leaves it closed.
    virtual usb::BusFinding open(const std::string& serial) = 0;
    virtual void close() noexcept = 0;
    // Waits for at most so long for a report: its size, 0 where none came, or kPortGone. Closed, it only waits.
    virtual int read(std::span<std::byte> into, Duration patience) noexcept = 0;
    virtual bool write(std::span<const std::byte> report) noexcept = 0;
    virtual Instant now() noexcept = 0;
};

}  // namespace tact::polhem
