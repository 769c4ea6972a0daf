// Error handling for a device that cannot be opened.
//
// Thread  the one that opens the device, at start-up
#pragma once

#include <string>

#include "hal/usb/bus.hpp"

namespace tact::usb {

// True if the device may become ready within seconds: it is just being connected, udev has not set its
// rights yet, or another program is ending.
[[nodiscard]] bool may_pass(BusFault fault) noexcept;

// Throws StartupError for the faults with the same text for every device: denied, busy, and all without
// their own text. `what` is the attempt: "opening the Falcon".
[[noreturn]] void refuse_open(const std::string& what, const BusFinding& found);

}  // namespace tact::usb
