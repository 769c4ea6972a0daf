// Looks for a device among those that libusb lists: by its kind, then by its serial.
//
// Thread  the bus's; it opens every candidate, since only an open device tells its serial
#pragma once

#include <string>

#include "hal/usb/bus.hpp"
#include "hal/usb/device_kind.hpp"

struct libusb_context;
struct libusb_device_handle;

namespace tact::usb {

// An open device: the caller closes its handle.
struct FoundDevice {
    libusb_device_handle* handle = nullptr;
    int interface = 0;
    unsigned char in = 0, out = 0;  // addresses of its endpoints
};

// Empty serial: the only device present. `device` is unchanged where there is a fault.
[[nodiscard]] BusFinding find_device(libusb_context* context, const DeviceKind& kind,
                                     const std::string& serial, FoundDevice& device);

}  // namespace tact::usb
