// The USB bus of this machine. StartupError where libusb itself does not start.
#pragma once

#include <memory>

#include "hal/phantom/usb_bus.hpp"

namespace tact::phantom {

[[nodiscard]] std::unique_ptr<UsbBus> make_libusb_bus();

}  // namespace tact::phantom
