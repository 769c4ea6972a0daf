// Zero of an arm's encoders, found once after power-on in a known pose. A pure state machine.
//
// reset_pose  a person holds the arm still in the reset pose (thigh horizontal, shin straight down, gimbal
//             straight) and confirms, on the device or on the screen: Premium
// inkwell     the stylus lies still in the inkwell: Omni
// automatic   the device calibrates itself and reports it: Desktop
// Force       none before `done`: the driver checks force_allowed() before it sends currents
// Restart     on any event that invalidates the counts (device lost, brown-out: counts_valid false; the
//             device's own calibration lost), also from `done`
// Thread      one; step() is TACT_RT
#pragma once

#include "hal/arm/arm_kinematics.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/device_notice.hpp"

namespace tact {

enum class CalibrationState : std::uint8_t { waiting, holding, done };

struct CalibrationInput {
    Counts6 counts{};
    bool counts_valid = false;       // a fresh packet, and no counts lost since power-on
    bool inkwell = false;            // inkwell switch: the stylus is in
    bool confirm = false;            // a person confirms the pose; the rising edge counts
    bool device_calibrated = false;  // the device reports that its counts are absolute
};

class Calibration {
public:
    explicit Calibration(const ArmParameters& parameters);

    CalibrationState step(const CalibrationInput& input, Instant now) noexcept TACT_RT;
    void restart() noexcept TACT_RT;

    [[nodiscard]] CalibrationState state() const noexcept { return state_; }
    [[nodiscard]] bool force_allowed() const noexcept { return state_ == CalibrationState::done; }
    // Counts in the pose of ArmParameters::calibration_rad; meaningful when done.
    [[nodiscard]] const Counts6& zero() const noexcept { return zero_; }
    // The action required of a person; none when done.
    [[nodiscard]] DeviceNotice asks() const noexcept TACT_RT;

    static constexpr Duration kHold = std::chrono::milliseconds(500);  // time without motion
    static constexpr Duration kSilence =
        std::chrono::milliseconds(100);         // a longer gap between steps restarts the hold
    static constexpr double kStillRad = 0.005;  // joint motion below this counts as still

private:
    void hold(const CalibrationInput& input, Instant now) noexcept;
    [[nodiscard]] bool still(const Counts6& counts) noexcept;

    CalibrationStyle style_;
    Counts6 tolerance_{};  // kStillRad in counts per joint; 0: no encoder
    CalibrationState state_ = CalibrationState::waiting;
    Counts6 lowest_{}, highest_{}, zero_{};
    Instant held_since_{}, stepped_at_{};
    bool confirm_before_ = true;  // a button that is already down at the start is no confirmation
};

}  // namespace tact
