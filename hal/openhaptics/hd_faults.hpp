// Maps errors of the vendor's library to their effect on the force.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/openhaptics/hd_api.hpp"
#include "ipc/base/device_notice.hpp"
#include "ipc/base/rt.hpp"

namespace tact::hd {

enum class FaultKind : std::uint8_t {
    none,
    motors_warm,  // 200: zero force until the motors are cool
    limit,        // 201 to 204: more force, impulse or speed than the device permits
    device,       // 300, 301: internal fault of the device
    link,         // 302: no communication; the library ends its scheduler
    timer,        // 304, and 400, 401: clock or frames broken; the library ends its scheduler
    frame,        // 402: the frame was not sent
    refused,      // 100 to 104, 600 and unknown codes: the library rejected a call
    calibration,  // not an error of the library: the device lost the zero of its encoders
};
inline constexpr std::size_t kFaultKinds = 9;

struct FaultMeaning {
    FaultKind kind;
    bool ends;            // no more samples: lost until opened again
    DeviceNotice notice;  // the nearest of the notices common to all devices
    const char* says;     // message for people
    const char* fixes;    // remedy for people
};

[[nodiscard]] const FaultMeaning& meaning(unsigned code) noexcept TACT_RT;
[[nodiscard]] const FaultMeaning& meaning(FaultKind kind) noexcept TACT_RT;

}  // namespace tact::hd
