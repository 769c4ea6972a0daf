#include "hal/openhaptics/hd_faults.hpp"

#include <array>

namespace tact::hd {

namespace {

// Indexed by FaultKind.
constexpr std::array<FaultMeaning, kFaultKinds> kMeanings{{
    {FaultKind::none, false, DeviceNotice::none, "no error", ""},
    {FaultKind::motors_warm, false, DeviceNotice::over_temperature, "the motors are too warm",
     "let the device cool for some minutes, then re-arm"},
    {FaultKind::limit, false, DeviceNotice::over_current,
     "the command exceeds the device's permitted force or speed",
     "lower safety.force_n_max or safety.force_slew_n_s, then re-arm"},
    {FaultKind::device, false, DeviceNotice::amplifier_off, "the device reports an internal fault",
     "switch it off and on, calibrate it, and start again"},
    {FaultKind::link, true, DeviceNotice::gone, "the connection to the device is broken",
     "check cable and power, then start again; the manufacturer's diagnostic program shows whether the "
     "device answers"},
    {FaultKind::timer, true, DeviceNotice::silent, "the library's scheduler stopped", "start again"},
    {FaultKind::frame, false, DeviceNotice::commands_not_taken, "a frame did not reach the device",
     "re-arm; if it happens again, check cable and power"},
    {FaultKind::refused, false, DeviceNotice::commands_not_taken, "the library rejected a call",
     "set device.hd_library to the libHD.so that belongs to the device, and check its licence"},
    {FaultKind::calibration, false, DeviceNotice::count_lost, "the device lost the zero of its encoders",
     "move the arm to its calibration pose, then re-arm"},
}};

}  // namespace

const FaultMeaning& meaning(FaultKind kind) noexcept {
    const auto at = static_cast<std::size_t>(kind);
    return kMeanings[at < kFaultKinds ? at : static_cast<std::size_t>(FaultKind::refused)];
}

const FaultMeaning& meaning(unsigned code) noexcept {
    switch (code) {
        case kSuccess:
            return meaning(FaultKind::none);
        case kWarmMotors:
            return meaning(FaultKind::motors_warm);
        case kExceededMaxForce:
        case kExceededImpulse:
        case kExceededVelocity:
        case kForceError:
            return meaning(FaultKind::limit);
        case kDeviceFault:
        case kDeviceInitiated:
            return meaning(FaultKind::device);
        case kCommunication:
            return meaning(FaultKind::link);
        case kTimer:
        case kIllegalBegin:
        case kIllegalEnd:
            return meaning(FaultKind::timer);
        case kFrameError:
            return meaning(FaultKind::frame);
        default:
            return meaning(FaultKind::refused);
    }
}

}  // namespace tact::hd
