#include "hal/arm/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

Calibration::Calibration(const ArmParameters& parameters) : style_(parameters.calibration) {
    for (std::size_t i = 0; i < 6; ++i) {
        const double rad = std::abs(parameters.rad_per_count[static_cast<Eigen::Index>(i)]);
        if (rad > 0.0) tolerance_[i] = std::max(1, static_cast<std::int32_t>(std::min(kStillRad / rad, 1e6)));
    }
}

void Calibration::restart() noexcept {
    state_ = CalibrationState::waiting;
    confirm_before_ = true;
}

bool Calibration::still(const Counts6& counts) noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
        if (tolerance_[i] == 0) continue;
        lowest_[i] = std::min(lowest_[i], counts[i]);
        highest_[i] = std::max(highest_[i], counts[i]);
        if (std::int64_t{highest_[i]} - lowest_[i] > tolerance_[i]) return false;
    }
    return true;
}

void Calibration::hold(const CalibrationInput& input, Instant now) noexcept {
    state_ = CalibrationState::holding;
    lowest_ = highest_ = input.counts;
    held_since_ = now;
}

CalibrationState Calibration::step(const CalibrationInput& input, Instant now) noexcept {
    const bool confirmed = input.confirm && !confirm_before_;
    const bool silent = now - stepped_at_ > kSilence;
    confirm_before_ = input.confirm;
    stepped_at_ = now;
    const bool lost =
        !input.counts_valid || (style_ == CalibrationStyle::automatic && !input.device_calibrated);
    if (lost) {
        state_ = CalibrationState::waiting;
        return state_;
    }
    if (state_ == CalibrationState::done) return state_;
    if (state_ == CalibrationState::waiting) {
        const bool begin = style_ == CalibrationStyle::reset_pose ? confirmed
                           : style_ == CalibrationStyle::inkwell  ? input.inkwell
                                                                  : true;
        if (begin) hold(input, now);
        return state_;
    }
    if (style_ == CalibrationStyle::automatic) {  // the arm may move meanwhile: its counts are absolute
        if (silent) hold(input, now);
    } else {
        const bool left = style_ == CalibrationStyle::inkwell && !input.inkwell;
        const bool moved = !still(input.counts);
        if (left || ((moved || silent) && style_ == CalibrationStyle::reset_pose)) {
            state_ = CalibrationState::waiting;  // the person must confirm again
            return state_;
        }
        if (moved || silent) hold(input, now);
    }
    if (now - held_since_ >= kHold) {
        state_ = CalibrationState::done;
        zero_ = Counts6{};
        for (std::size_t i = 0; i < 6 && style_ != CalibrationStyle::automatic; ++i) {
            zero_[i] = static_cast<std::int32_t>((std::int64_t{lowest_[i]} + highest_[i]) / 2);
        }
    }
    return state_;
}

DeviceNotice Calibration::asks() const noexcept {
    if (state_ == CalibrationState::done) return DeviceNotice::none;
    const bool waits = state_ == CalibrationState::waiting;
    switch (style_) {
        case CalibrationStyle::reset_pose:
            return waits ? DeviceNotice::hold_reset_pose : DeviceNotice::keep_still;
        case CalibrationStyle::inkwell:
            return waits ? DeviceNotice::stylus_into_inkwell : DeviceNotice::stylus_stays_in_inkwell;
        default:
            return DeviceNotice::move_about;
    }
}

}  // namespace tact
