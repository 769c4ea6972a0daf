// Where an arm's encoders count from: found once after power-on, in a pose that is known. A pure state
// machine.
//
// reset_pose  a person holds the arm still in the reset pose (thigh level, shin hanging, gimbal straight) and
//             confirms, on the device or on the screen: Premium
// inkwell     the stylus lies still in the inkwell: Omni
// automatic   the device calibrates itself and says so: Desktop
// Force       none before `done`: the driver asks force_allowed() before it gives currents
// Anew        whatever makes the counts worthless (device lost, brown-out: counts_valid false; the
//             device's own calibration gone) leads back to the start, also from `done`
// Thread      one; step() is TACT_RT
#pragma once

#include "hal/arm/arm_kinematics.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/device_notice.hpp"

namespace tact {

enum class CalibrationState : std::uint8_t { waiting, holding, done };

struct CalibrationInput {
    Counts6 counts{};
    bool counts_valid = false;       // a fresh packet, and the device has not lost count
    bool inkwell = false;            // its switch says the stylus is in
    bool confirm = false;            // a person says the pose is right; the rising edge counts
    bool device_calibrated = false;  // the device says its counts are absolute
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
    // What a person has to do now; none when done.
    [[nodiscard]] DeviceNotice asks() const noexcept TACT_RT;

    static constexpr Duration kHold = std::chrono::milliseconds(500);  // still for so long
    static constexpr Duration kSilence =
        std::chrono::milliseconds(100);         // between steps: the hold begins anew
    static constexpr double kStillRad = 0.005;  // a joint moves by less than this

private:
    void hold(const CalibrationInput& input, Instant now) noexcept;
    [[nodiscard]] bool still(const Counts6& counts) noexcept;

    CalibrationStyle style_;
    Counts6 tolerance_{};  // counts of kStillRad a joint; 0: no encoder there
    CalibrationState state_ = CalibrationState::waiting;
    Counts6 lowest_{}, highest_{}, zero_{};
    Instant held_since_{}, stepped_at_{};
    bool confirm_before_ = true;  // a button that is down from the start is no confirmation
};

}  // namespace tact
