// Finds a device in libusb's list: by its kind, then by its serial number.
//
// Thread  the bus's; opens every candidate, since only an open device reports its serial number
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

// Empty serial: the only device present. On a fault, `device` is unchanged.
[[nodiscard]] BusFinding find_device(libusb_context* context, const DeviceKind& kind,
                                     const std::string& serial, FoundDevice& device);

}  // namespace tact::usb
