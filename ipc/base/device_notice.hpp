// Notice from a haptic device to its user: a required action, or the reason for zero force. One byte, so
// that it fits every topic.
#pragma once

#include <cstdint>

#include "ipc/base/rt.hpp"

namespace tact {

enum class DeviceNotice : std::uint8_t {
    none,
    // Required actions.
    hold_reset_pose,
    keep_still,
    stylus_into_inkwell,
    stylus_stays_in_inkwell,
    move_about,
    // Zero force until a person resets the fault.
    gone,
    silent,
    commands_not_taken,
    watchdog_tripped,
    amplifier_off,
    over_temperature,
    brown_out,
    safety_open,
    over_current,
    count_lost,
    restarted,
    drive_broken,
    encoder_stuck,
    encoder_jumped,
    // Warnings: operation continues.
    states_refused,
    // Required action, as the first ones; recordings contain these numbers, so that a new one is the last.
    not_initialized,
};
inline constexpr std::uint8_t kDeviceNotices = 22;

[[nodiscard]] constexpr bool asks(DeviceNotice n) noexcept TACT_RT {
    return (n >= DeviceNotice::hold_reset_pose && n <= DeviceNotice::move_about) ||
           n == DeviceNotice::not_initialized;
}

[[nodiscard]] constexpr const char* device_notice_text(DeviceNotice n) noexcept {
    switch (n) {
        case DeviceNotice::none:
            return "";
        case DeviceNotice::hold_reset_pose:
            return "hold the arm in its reset pose (thigh level, shin straight down, gimbal straight) and "
                   "confirm with its button";
        case DeviceNotice::keep_still:
            return "keep the arm still";
        case DeviceNotice::stylus_into_inkwell:
            return "put the stylus into the inkwell";
        case DeviceNotice::stylus_stays_in_inkwell:
            return "leave the stylus in the inkwell";
        case DeviceNotice::move_about:
            return "move the arm slowly through its workspace until it has calibrated itself";
        case DeviceNotice::gone:
            return "the device is unplugged or has no power";
        case DeviceNotice::silent:
            return "the device sent no valid data for three periods";
        case DeviceNotice::commands_not_taken:
            return "the device does not accept its commands";
        case DeviceNotice::watchdog_tripped:
            return "the device's watchdog switched its amplifier off";
        case DeviceNotice::amplifier_off:
            return "the amplifier switched off unexpectedly";
        case DeviceNotice::over_temperature:
            return "a motor or the amplifier is too hot";
        case DeviceNotice::brown_out:
            return "the amplifier's supply voltage dropped";
        case DeviceNotice::safety_open:
            return "the emergency stop or the dead-man switch is open";
        case DeviceNotice::over_current:
            return "a motor drew too much current";
        case DeviceNotice::count_lost:
            return "an encoder lost counts";
        case DeviceNotice::restarted:
            return "the device restarted";
        case DeviceNotice::drive_broken:
            return "a motor's current deviates from its command";
        case DeviceNotice::encoder_stuck:
            return "an encoder does not move although its motor drives";
        case DeviceNotice::encoder_jumped:
            return "an encoder moved faster than the arm can move";
        case DeviceNotice::states_refused:
            return "more than 5 % of the device's packets are bad or lost";
        case DeviceNotice::not_initialized:
            return "initialize the arm with the manufacturer's program (HapticInit), or start again with "
                   "device.fd_initialize = true";
    }
    return "unknown";
}

}  // namespace tact
