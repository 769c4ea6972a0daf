// Maps errors of the Force Dimension library, and causes of a force that went off, to their effect.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ipc/base/device_notice.hpp"
#include "ipc/base/rt.hpp"

namespace tact::fd {

enum class FaultKind : std::uint8_t {
    none,
    link,            // no communication, or the device is gone: closed, and searched again
    busy,            // another program uses the device
    device,          // the controller reports an error, or the redundant encoders disagree
    refused,         // the library rejected a call
    button,          // the force button, or the dead-man sensor of the handle, switched the force off
    velocity,        // the device's own velocity limit switched the force off
    firmware,        // the device's own watchdog switched the force off
    force_off,       // the force is off for another reason
    not_initialized  // the device does not know the zero of its encoders
};
inline constexpr std::size_t kFaultKinds = 10;

struct FaultMeaning {
    FaultKind kind;
    DeviceNotice notice;  // the nearest of the notices common to all devices
    const char* says;     // message for people
    const char* fixes;    // remedy for people
};

[[nodiscard]] const FaultMeaning& meaning(FaultKind kind) noexcept TACT_RT;
[[nodiscard]] FaultKind fault_of_error(int code) noexcept TACT_RT;       // of dhdErrorGetLast()
[[nodiscard]] FaultKind fault_of_force_off(int cause) noexcept TACT_RT;  // of the device's status

}  // namespace tact::fd
