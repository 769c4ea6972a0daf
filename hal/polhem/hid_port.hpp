// Source and sink of the reports: the kernel's hidraw, or a test.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "hal/usb/bus.hpp"

namespace tact::polhem {

inline constexpr int kPortGone = -1;  // unplugged or failed: no data until open()

class HidPort {
public:
    virtual ~HidPort() = default;
    // Empty serial: the only board connected. On any result but `none` the port stays closed.
    virtual usb::BusFinding open(const std::string& serial) = 0;
    virtual void close() noexcept = 0;
    // Waits at most `patience` for a report; returns its size, 0 without one, or kPortGone. When closed, only waits.
    virtual int read(std::span<std::byte> into, Duration patience) noexcept = 0;
    virtual bool write(std::span<const std::byte> report) noexcept = 0;
    virtual Instant now() noexcept = 0;
};

}  // namespace tact::polhem
