// Reports through /dev/hidraw*: a kernel interface, no library. A board with several interfaces has its
// reports on the first.
//
// Errors    a BusFault from open(); kPortGone once the node fails
// Thread    one thread; open() may search through /sys
#pragma once

#include <filesystem>

#include "hal/polhem/hid_port.hpp"
#include "hal/probe/buses.hpp"

namespace tact::polhem {

inline constexpr std::uint16_t kVendor = 0x16c0, kProduct = 0x0486;

// The board with that serial number (empty: the only one) and its node; a pure function, for tests.
[[nodiscard]] usb::BusFinding find_board(const probe::Bus<probe::UsbDevice>& usb, const std::string& serial,
                                         std::string& node);

class HidrawPort final : public HidPort {
public:
    explicit HidrawPort(std::filesystem::path root = "/") : root_(std::move(root)) {}
    explicit HidrawPort(int fd) : fd_(fd) {}  // for tests; takes ownership of fd
    ~HidrawPort() override { close(); }
    HidrawPort(const HidrawPort&) = delete;
    HidrawPort& operator=(const HidrawPort&) = delete;

    usb::BusFinding open(const std::string& serial) override;
    void close() noexcept override;
    int read(std::span<std::byte> into, Duration patience) noexcept override;
    bool write(std::span<const std::byte> report) noexcept override;
    Instant now() noexcept override { return Monotonic::now(); }

private:
    std::filesystem::path root_;
    int fd_ = -1;
};

}  // namespace tact::polhem
