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
    : api_(&api), device_(device), mailbox_(std::make_unique<Mailbox>()) {}

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
    if (answered_ns_ != 0) sample_.delay_ns = to_ns(now) - answered_ns_ + settings_.transport.count();
    answered_ns_ = 0;
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
    if (before && (state_ == DeviceState::powered || counts_.ticks % kCalibrationEvery != 0) &&
        !(inkwell_ && state_ == DeviceState::ready))
        return;
    const Enum status = api_->hdCheckCalibration();
    if (status == kCalibrationOk) {
        calibrated_ = true;
        return;
    }
    if (state_ == DeviceState::powered) return;  // the position must not jump under a force
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
    state_ = DeviceState::fault;
    failed_at_ = now;
    ended_ = ended_ || ends;
    // The next frame carries zero force; the output is off at once.
    if (output_on_) api_->hdDisable(kForceOutput);
    output_on_ = false;
}

void Pump::apply(Instant now) noexcept {
    if (!mailbox_->command.read(command_)) {
        if (mailbox_->command.count() == 0) return;  // lapped: the last command and its watchdog stay
    }
    if (command_.heartbeat != heartbeat_) {
        heartbeat_ = command_.heartbeat;
        heard_at_ = now;
        answered_ns_ = command_.answers_ns;
    }
    const bool on = command_.enable != 0;
    const bool edge = on && command_.edge != edge_;
    const bool relaxed = command_.relaxed != relaxed_;
    // Before calibration, an edge is kept until calibration completes, unless enable falls again.
    if (calibrated_ || relaxed || state_ == DeviceState::fault) edge_ = command_.edge;
    relaxed_ = command_.relaxed;
    if (state_ == DeviceState::fault) {
        if (!on && now - failed_at_ >= kQuiet && !ended_) state_ = DeviceState::ready;
        return;
    }
    if (!on || (relaxed && !edge)) {
        state_ = DeviceState::ready;
    } else if (edge && calibrated_) {
        state_ = DeviceState::powered;
    }
    if (state_ == DeviceState::powered && now - heard_at_ > settings_.watchdog) {
        state_ = DeviceState::watchdog_tripped;
        ++counts_.watchdog_trips;
    }
}

void Pump::show() noexcept {
    Vec3 force_n = Vec3::Zero(), torque_mn_m = Vec3::Zero();
    const bool on = state_ == DeviceState::powered;
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
    sample_.state = static_cast<std::uint8_t>(state_);
    sample_.ended = ended_ ? 1 : 0;
    const DeviceNotice notice = state_ == DeviceState::fault              ? meaning(counts_.last_kind).notice
                                : state_ == DeviceState::watchdog_tripped ? DeviceNotice::watchdog_tripped
                                                                          : asked();
    sample_.notice = static_cast<std::uint8_t>(notice);
    const auto failed = [this](FaultKind kind) { return counts_.faults[static_cast<std::size_t>(kind)]; };
    sample_.bus.packets = saturated(sample_.sequence);
    sample_.bus.refused = saturated(counts_.refused_samples);
    sample_.bus.transfers_failed = saturated(failed(FaultKind::link) + failed(FaultKind::frame));
    sample_.bus.commands_refused = saturated(failed(FaultKind::refused));
    if (sample_.sequence > 0) mailbox_->sample.publish(sample_);
    mailbox_->counts.publish(counts_);
}

IoStatus Pump::read(DeviceSample& newest, Instant now) noexcept {
    SampleWords w;
    if (!mailbox_->sample.read(w))
        return status_ = mailbox_->sample.count() == 0 ? IoStatus::lost : IoStatus::stale;
    taken_at_ns_ = w.taken_at_ns;
    newest.taken_at = std::min(instant_from_ns(w.taken_at_ns), now);
    newest.delay = Duration(w.delay_ns);
    newest.sequence = w.sequence;
    newest.T_dev_tool.p_m = Eigen::Map<const Vec3>(w.pos_m);
    newest.T_dev_tool.q = Quat(w.quat_xyzw[3], w.quat_xyzw[0], w.quat_xyzw[1], w.quat_xyzw[2]);
    newest.twist_dev = {Eigen::Map<const Vec3>(w.linear_m_s), Eigen::Map<const Vec3>(w.angular_rad_s)};
    newest.buttons = w.buttons;
    newest.hand_present = w.hand_present != 0;
    newest.state = static_cast<DeviceState>(w.state);
    newest.notice = static_cast<DeviceNotice>(w.notice);
    newest.bus = w.bus;
    const bool fresh = w.sequence != sequence_;
    sequence_ = w.sequence;
    if (w.ended != 0 || now - newest.taken_at > kLostAfter) return status_ = IoStatus::lost;
    if (newest.state == DeviceState::fault) return status_ = IoStatus::fault;
    return status_ = fresh ? IoStatus::ok : IoStatus::stale;
}

IoStatus Pump::write(const DeviceCommand& command) noexcept {
    if (!command.enable) low_seen_ = true;
    if (command.enable && low_seen_) {
        low_seen_ = false;
        ++edges_sent_;
    }
    CommandWords w{};
    for (int i = 0; i < 3; ++i) {
        w.force_n[i] = command.wrench_dev.force_n[i];
        w.torque_n_m[i] = command.wrench_dev.torque_n_m[i];
    }
    w.enable = command.enable ? 1 : 0;
    w.edge = edges_sent_;
    w.relaxed = relaxed_sent_;
    w.heartbeat = heartbeat_sent_ = command.heartbeat;
    w.answers_ns = taken_at_ns_;
    mailbox_->command.publish(w);
    return status_ == IoStatus::lost || status_ == IoStatus::fault ? status_ : IoStatus::ok;
}

void Pump::relax() noexcept {
    low_seen_ = false;  // an enable that is still high is no edge
    ++relaxed_sent_;
    CommandWords w{};
    // A heartbeat outside the servo loop's range, so that relax() does not count as silence.
    w.heartbeat = ++heartbeat_sent_ | 1ULL << 63U;
    w.edge = edges_sent_;
    w.relaxed = relaxed_sent_;
    mailbox_->command.publish(w);
}

Counts Pump::counts() const noexcept {
    Counts c;
    static_cast<void>(mailbox_->counts.read(c));
    return c;
}

}  // namespace tact::hd
