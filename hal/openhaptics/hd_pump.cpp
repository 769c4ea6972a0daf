#include "hal/openhaptics/hd_pump.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/shortened.hpp"

namespace tact::hd {

namespace {

constexpr int kErrorsMax =
    16;  // taken from the stack per tick, so that a stack that never empties cannot block the tick
constexpr double kReachMm = 1000.0, kSpeedMmS = 20000.0, kTurnRadS = 500.0;  // beyond any arm
constexpr double kRotationError = 1e-3;
constexpr std::uint64_t kCalibrationEvery = 64;  // ticks

bool within(const Vec3& v, double most) noexcept { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

bool rotation(const Eigen::Matrix3d& r) noexcept {
    return r.allFinite() && r.cwiseAbs().maxCoeff() < 2.0 && r.determinant() > 0.0 &&
           (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRotationError;
}

}  // namespace

Pump::Pump(const Api& api, Handle device)
    : api_(&api), device_(device), published_(std::make_unique<Latest<Counts>>()) {}

Enum Pump::tick(Instant now) noexcept {
    if (ended_) return kCallbackDone;
    ++counts_.ticks;
    api_->hdBeginFrame(device_);
    take_sample(now);
    calibrate(now);
    take_errors(now);  // of this frame so far: an error makes its force zero
    apply(now);
    show();
    api_->hdEndFrame(device_);
    take_errors(now);
    publish();
    return ended_ ? kCallbackDone : kCallbackContinue;
}

void Pump::take_sample(Instant now) noexcept {
    std::array<double, 16> t{};
    Vec3 speed_mm_s = Vec3::Zero(), turn_rad_s = Vec3::Zero();
    int buttons = 0;
    Boolean inkwell = 0;
    api_->hdGetDoublev(kTransform, t.data());
    api_->hdGetDoublev(kVelocity, speed_mm_s.data());
    api_->hdGetDoublev(kAngularVelocity, turn_rad_s.data());
    api_->hdGetIntegerv(kButtons, &buttons);
    api_->hdGetBooleanv(kInkwellSwitch, &inkwell);
    inkwell_ = inkwell != 0;
    Eigen::Matrix3d r;
    r << t[0], t[4], t[8], t[1], t[5], t[9], t[2], t[6], t[10];
    const Vec3 at_mm(t[12], t[13], t[14]);
    if (!within(at_mm, kReachMm) || !within(speed_mm_s, kSpeedMmS) || !within(turn_rad_s, kTurnRadS) ||
        !rotation(r)) {
        ++counts_.refused_samples;
        return;
    }
    position_mm_ = at_mm;
    const Quat q = Quat(r).normalized();
    for (int i = 0; i < 3; ++i) {
        sample_.pos_m[i] = 1e-3 * (at_mm[i] - settings_.centre_mm[i]);
        sample_.linear_m_s[i] = 1e-3 * speed_mm_s[i];
        sample_.angular_rad_s[i] = turn_rad_s[i];
    }
    for (int i = 0; i < 4; ++i) sample_.quat_xyzw[i] = q.coeffs()[i];
    if (const std::int64_t answered_ns = gate_.take_answered(); answered_ns != 0)
        sample_.delay_ns = to_ns(now) - answered_ns + settings_.transport.count();
    sample_.buttons = static_cast<std::uint32_t>(buttons);
    sample_.hand_present = inkwell_ ? 0 : 1;
    sample_.taken_at_ns = to_ns(now);
    ++sample_.sequence;
}

// In the reset pose, the user holds the arm still for half a second and presses its button.
bool Pump::confirmed(Instant now) noexcept {
    const bool button = (sample_.buttons & 1U) != 0;
    const bool pressed = button && !button_before_;
    button_before_ = button;
    if ((position_mm_ - held_mm_).norm() > kStillMm || held_since_ == Instant{}) {
        held_mm_ = position_mm_;
        held_since_ = now;
    }
    return pressed && now - held_since_ >= kHold;
}

void Pump::calibrate(Instant now) noexcept {
    const bool before = calibrated_;
    const bool confirm = confirmed(now);
    if (before && (gate_.state() == DeviceState::powered || counts_.ticks % kCalibrationEvery != 0) &&
        !(inkwell_ && gate_.state() == DeviceState::ready))
        return;
    const Enum status = api_->hdCheckCalibration();
    if (status == kCalibrationOk) {
        calibrated_ = true;
        return;
    }
    if (gate_.state() == DeviceState::powered) return;  // the position must not jump under a force
    int style = 0;
    if ((settings_.styles & kStyleAutomatic) != 0 && status == kCalibrationNeedsUpdate)
        style = kStyleAutomatic;
    else if ((settings_.styles & kStyleInkwell) != 0 && inkwell_)
        style = kStyleInkwell;
    else if ((settings_.styles & kStyleEncoderReset) != 0 && confirm)
        style = kStyleEncoderReset;
    if (style != 0) {
        api_->hdUpdateCalibration(static_cast<Enum>(style));
        ++counts_.calibrations;
    } else if (before && status == kCalibrationNeedsManualInput) {
        calibrated_ = false;
        fail(FaultKind::calibration, false, now);
    }
}

void Pump::take_errors(Instant now) noexcept {
    for (int n = 0; n < kErrorsMax; ++n) {
        const ErrorInfo error = api_->hdGetError();
        if (error.code == kSuccess) return;
        counts_.last_code = error.code;
        const FaultMeaning& m = meaning(error.code);
        fail(m.kind, m.ends, now);
    }
}

void Pump::fail(FaultKind kind, bool ends, Instant now) noexcept {
    ++counts_.faults[static_cast<std::size_t>(kind)];
    counts_.last_kind = kind;
    gate_.fail(now);
    ended_ = ended_ || ends;
    // The next frame carries zero force; the output is off at once.
    if (output_on_) api_->hdDisable(kForceOutput);
    output_on_ = false;
}

void Pump::apply(Instant now) noexcept {
    if (!mail_.fetch(command_)) return;
    gate_.apply(command_, now, calibrated_, ended_);
    counts_.watchdog_trips = gate_.trips();
}

void Pump::show() noexcept {
    Vec3 force_n = Vec3::Zero(), torque_mn_m = Vec3::Zero();
    const bool on = gate_.state() == DeviceState::powered;
    if (on) {
        const Vec3 f = Eigen::Map<const Vec3>(command_.force_n),
                   t = Eigen::Map<const Vec3>(command_.torque_n_m);
        if (f.allFinite() && t.allFinite()) {
            force_n = shortened(f, settings_.force_n_max);
            torque_mn_m = 1e3 * shortened(t, settings_.torque_n_m_max);
        } else {
            ++counts_.refused_commands;
        }
    }
    if (on != output_on_) (on ? api_->hdEnable : api_->hdDisable)(kForceOutput);
    output_on_ = on;
    api_->hdSetDoublev(kForce, force_n.data());
    if (settings_.torque_n_m_max > 0.0) api_->hdSetDoublev(kTorque, torque_mn_m.data());
}

DeviceNotice Pump::asked() const noexcept {
    if (calibrated_) return DeviceNotice::none;
    if ((settings_.styles & kStyleAutomatic) != 0) return DeviceNotice::move_about;
    if ((settings_.styles & kStyleInkwell) != 0)
        return inkwell_ ? DeviceNotice::stylus_stays_in_inkwell : DeviceNotice::stylus_into_inkwell;
    return DeviceNotice::hold_reset_pose;
}

void Pump::publish() noexcept {
    if (!calibrated_) {  // the pose is not valid yet
        std::fill_n(sample_.pos_m, 3, 0.0);
        std::fill_n(sample_.linear_m_s, 3, 0.0);
        std::fill_n(sample_.angular_rad_s, 3, 0.0);
        std::fill_n(sample_.quat_xyzw, 3, 0.0);
        sample_.quat_xyzw[3] = 1.0;
        sample_.hand_present = 0;
    }
    sample_.state = static_cast<std::uint8_t>(gate_.state());
    sample_.ended = ended_ ? 1 : 0;
    const DeviceNotice notice = gate_.state() == DeviceState::fault ? meaning(counts_.last_kind).notice
                                : gate_.state() == DeviceState::watchdog_tripped
                                    ? DeviceNotice::watchdog_tripped
                                    : asked();
    sample_.notice = static_cast<std::uint8_t>(notice);
    const auto failed = [this](FaultKind kind) { return counts_.faults[static_cast<std::size_t>(kind)]; };
    sample_.bus.packets = saturated(sample_.sequence);
    sample_.bus.refused = saturated(counts_.refused_samples);
    sample_.bus.transfers_failed = saturated(failed(FaultKind::link) + failed(FaultKind::frame));
    sample_.bus.commands_refused = saturated(failed(FaultKind::refused));
    if (sample_.sequence > 0) mail_.publish(sample_);
    published_->publish(counts_);
}

Counts Pump::counts() const noexcept {
    Counts c;
    static_cast<void>(published_->read(c));
    return c;
}

}  // namespace tact::hd
