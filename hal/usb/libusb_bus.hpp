// The USB bus of this computer, for devices of one kind.
#pragma once

#include <memory>

#include "hal/usb/bus.hpp"
#include "hal/usb/device_kind.hpp"

namespace tact::usb {

[[nodiscard]] std::unique_ptr<Bus> make_libusb_bus(const DeviceKind& kind);

}  // namespace tact::usb
