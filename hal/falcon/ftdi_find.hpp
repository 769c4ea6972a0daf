// Looks for Falcons on the USB bus, by the numbers of their converter.
#pragma once

#include <libusb.h>

#include <string>

#include "hal/falcon/ftdi.hpp"

namespace tact::falcon {

struct FoundFtdi {
    phantom::BusFinding finding;
    libusb_device_handle* handle = nullptr;  // open where the finding has no fault: the caller closes it
    unsigned char in = 0, out = 0;           // addresses of its bulk endpoints
};

// Empty serial: the only one there is.
[[nodiscard]] FoundFtdi find_ftdi(libusb_context* context, const std::string& serial);

}  // namespace tact::falcon
