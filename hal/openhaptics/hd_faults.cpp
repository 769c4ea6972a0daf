#include "hal/openhaptics/hd_faults.hpp"

#include <array>

namespace tact::hd {

namespace {

// By kind, in its order.
constexpr std::array<FaultMeaning, kFaultKinds> kMeanings{{
    {FaultKind::none, false, DeviceNotice::none, "no error", ""},
    {FaultKind::motors_warm, false, DeviceNotice::over_temperature, "its motors are too warm",
     "let it cool for some minutes, then re-arm"},
    {FaultKind::limit, false, DeviceNotice::over_current, "more force or speed than the device permits",
     "lower safety.force_n_max or safety.force_slew_n_s, then re-arm"},
    {FaultKind::device, false, DeviceNotice::amplifier_off, "the device reports a fault of its own",
     "switch it off and on, calibrate it, and start again"},
    {FaultKind::link, true, DeviceNotice::gone, "the connection to the device broke",
     "check cable and power, then start again; the maker's diagnostic program shows whether it answers"},
    {FaultKind::timer, true, DeviceNotice::silent, "the library's scheduler broke off", "start again"},
    {FaultKind::frame, false, DeviceNotice::commands_not_taken, "a frame did not reach the device",
     "re-arm; again: check cable and power"},
    {FaultKind::refused, false, DeviceNotice::commands_not_taken, "the library refuses what it was asked",
     "name the libHD.so that belongs to the device (device.hd_library) and see to its licence"},
    {FaultKind::calibration, false, DeviceNotice::count_lost, "it lost where its encoders count from",
     "bring it to its calibration pose, then re-arm"},
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
