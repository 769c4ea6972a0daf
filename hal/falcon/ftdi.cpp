#include "hal/falcon/ftdi.hpp"

#include "hal/usb/libusb_bus.hpp"

namespace tact::falcon {

usb::Piece ftdi::piece_of(std::span<const std::byte> packet) noexcept {
    constexpr std::byte kDamaged{0x1E};
    if (packet.size() < kStatusBytes || packet.size() > kPacketBytes) return {{}, true};
    const bool damaged = (packet[1] & kDamaged) != std::byte{0};
    return {damaged ? std::span<const std::byte>() : packet.subspan(kStatusBytes), damaged};
}

std::unique_ptr<usb::Bus> make_ftdi_bus() {
    return usb::make_libusb_bus(
        {.vendor = ftdi::kVendor, .product = ftdi::kProduct, .bulk = true, .unpack = &ftdi::piece_of});
}

}  // namespace tact::falcon
