// What an error of the vendor's library means for the force: one table, pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/openhaptics/hd_api.hpp"
#include "ipc/base/device_notice.hpp"
#include "ipc/base/rt.hpp"

namespace tact::hd {

enum class FaultKind : std::uint8_t {
    none,
    motors_warm,  // 200: force zero until it is cool
    limit,        // 201 to 204: more force, impulse or speed than the device permits
    device,       // 300, 301: its own fault
    link,         // 302: no communication; the library ends its scheduler
    timer,        // 304, and 400, 401: its clock or its frames are broken; it ends its scheduler
    frame,        // 402: the frame did not go out
    refused,      // 100 to 104, 600 and what is unknown: a call that it does not understand
    calibration,  // not an error of the library: it lost where its encoders count from
};
inline constexpr std::size_t kFaultKinds = 9;

struct FaultMeaning {
    FaultKind kind;
    bool ends;            // nothing comes any more: lost until opened again
    DeviceNotice notice;  // the nearest that every device can say
    const char* says;     // for people
    const char* fixes;    // what a person does about it
};

[[nodiscard]] const FaultMeaning& meaning(unsigned code) noexcept TACT_RT;
[[nodiscard]] const FaultMeaning& meaning(FaultKind kind) noexcept TACT_RT;

}  // namespace tact::hd
