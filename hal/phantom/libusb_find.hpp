// Looks for an arm's amplifier board among what libusb lists: by the interface that PROTOCOL.md gives it, then by
// its serial.
//
// Thread  the bus's; it opens every candidate, since only an open device tells its serial
#pragma once

#include <string>

#include "hal/phantom/usb_bus.hpp"

struct libusb_context;
struct libusb_device_handle;

namespace tact::phantom {

// Where the board's interface and endpoints are.
struct UsbBoard {
    int interface = 0;
    unsigned char in = 0, out = 0;
    std::string serial;
};

// Empty serial: the only board there is. `handle` is open where the fault is none, and unchanged otherwise.
[[nodiscard]] BusFinding find_board(libusb_context* context, const std::string& serial, UsbBoard& board,
                                    libusb_device_handle*& handle);

}  // namespace tact::phantom
