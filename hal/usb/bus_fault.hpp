// What a driver does about a device that it cannot open.
//
// Thread  the one that opens the device, at start-up
#pragma once

#include <string>

#include "hal/usb/bus.hpp"

namespace tact::usb {

// The device may become ready within seconds: it is being plugged in, udev has not set its rights yet, or another
// program is ending.
[[nodiscard]] bool may_pass(BusFault fault) noexcept;

// Throws StartupError for the faults whose text is the same for every device: denied, busy, and all that have no
// text of their own. `what` names the attempt: "opening the Falcon".
[[noreturn]] void refuse_open(const std::string& what, const BusFinding& found);

}  // namespace tact::usb
