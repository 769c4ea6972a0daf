#include "hal/usb/bus_fault.hpp"

#include "ipc/base/error.hpp"
#include "ipc/base/rights.hpp"

namespace tact::usb {

bool may_pass(BusFault fault) noexcept {
    return fault == BusFault::missing || fault == BusFault::denied || fault == BusFault::not_ready ||
           fault == BusFault::busy;
}

void refuse_open(const std::string& what, const BusFinding& found) {
    if (found.fault == BusFault::denied)
        throw StartupError(what, "this user has no right to open the device (" + found.detail + ")",
                           kDeviceRightsFix);
    if (found.fault == BusFault::busy)
        throw StartupError(what, "another program uses the device (" + found.detail + ")",
                           "end that program; lsof lists it");
    throw StartupError(what, found.detail, "unplug it and plug it in again; see dmesg");
}

}  // namespace tact::usb
