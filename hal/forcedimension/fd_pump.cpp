#include "hal/forcedimension/fd_pump.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/shortened.hpp"

namespace tact::fd {

namespace {

constexpr double kFdReachM = 0.5, kFdSpeedMS = 20.0, kFdTurnRadS = 500.0;  // beyond any arm
constexpr double kFdRotationError = 1e-3;
constexpr double kTransportPeriods = 2.0;

bool inside(const Vec3& v, double most) noexcept { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

bool is_rotation(const Eigen::Matrix3d& r) noexcept {
    return r.allFinite() && r.cwiseAbs().maxCoeff() < 2.0 && r.determinant() > 0.0 &&
           (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kFdRotationError;
}

// The same turn, in Tact's axes.
Eigen::Matrix3d tact_turn(const double (&r)[3][3]) noexcept {
    constexpr std::array<int, 3> kFrom{1, 2, 0};  // as tact_axes()
    Eigen::Matrix3d t;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            t(i, j) = r[kFrom[static_cast<std::size_t>(i)]][kFrom[static_cast<std::size_t>(j)]];
    return t;
}

}  // namespace

Pump::Pump(const Api& api, Session& session)
    : api_(&api), session_(&session), published_(std::make_unique<Latest<Counts>>()) {
    sample_.quat_xyzw[3] = 1.0;
}

void Pump::round(Instant now) noexcept {
    ++counts_.rounds;
    if (session_->is_open()) {
        take_sample(now);
        if (session_->is_open() && counts_.rounds % kStatusEvery == 0) take_status(now);
    } else {
        reopen(now);
    }
    apply(now);
    if (session_->is_open()) send(now);
    publish();
}

// A negative result is an error; a lost device is closed.
void Pump::check(int result, Instant now) noexcept {
    if (result >= 0) return;
    counts_.last_code = api_->dhdErrorGetLast();
    fail(fault_of_error(counts_.last_code), now);
}

void Pump::fail(FaultKind kind, Instant now) noexcept {
    ++counts_.faults[static_cast<std::size_t>(kind)];
    counts_.last_kind = kind;
    gate_.fail(now);
    if (!session_->is_open()) return;
    switch_output(false, now);
    if (kind != FaultKind::link && kind != FaultKind::busy && kind != FaultKind::not_initialized) return;
    session_->close();
    waits_ = kind == FaultKind::not_initialized;
    retry_at_ = now + kReopenEvery;
}

void Pump::reopen(Instant now) noexcept {
    if (now < retry_at_) return;
    retry_at_ = now + kReopenEvery;
    const OpenResult result = session_->open(false);
    waits_ = result.failure == OpenFailure::not_initialized;
    if (waits_) counts_.last_kind = FaultKind::not_initialized;
    if (result.failure != OpenFailure::none) return;
    ++counts_.reopened;
    gripped_ = false;
}

void Pump::take_sample(Instant now) noexcept {
    Vec3 at_m = Vec3::Zero();
    double turn[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const int result = session_->wrist() ? api_->dhdGetPositionAndOrientationFrame(
                                               &at_m[0], &at_m[1], &at_m[2], turn, session_->id())
                                         : api_->dhdGetPosition(&at_m[0], &at_m[1], &at_m[2], session_->id());
    if (result < 0) return check(result, now);
    if (result == kTimeGuard) {
        ++counts_.repeated_samples;
        return;
    }
    const Eigen::Matrix3d r = tact_turn(turn);
    if (!inside(at_m, kFdReachM) || !is_rotation(r)) {
        ++counts_.refused_samples;
        return;
    }
    const Vec3 at_tact_m = tact_axes(at_m - Eigen::Map<const Vec3>(session_->model().centre_m));
    const Quat q = Quat(r).normalized();
    for (int i = 0; i < 3; ++i) sample_.pos_m[i] = at_tact_m[i];
    for (int i = 0; i < 4; ++i) sample_.quat_xyzw[i] = q.coeffs()[i];
    take_velocity();
    take_buttons();
    if (const std::int64_t answered_ns = gate_.take_answered(); answered_ns != 0)
        sample_.delay_ns = to_ns(now) - answered_ns + transport_.count();
    sample_.hand_present = 1;
    sample_.taken_at_ns = to_ns(now);
    ++sample_.sequence;
}

// The library's estimator needs several samples: until then, and for an impossible value, zero.
void Pump::take_velocity() noexcept {
    Vec3 linear_m_s = Vec3::Zero(), angular_rad_s = Vec3::Zero();
    const char id = session_->id();
    if (api_->dhdGetLinearVelocity(&linear_m_s[0], &linear_m_s[1], &linear_m_s[2], id) < 0 ||
        !inside(linear_m_s, kFdSpeedMS)) {
        ++counts_.missing_velocities;
        linear_m_s.setZero();
    }
    if (session_->wrist() &&
        (api_->dhdGetAngularVelocityRad(&angular_rad_s[0], &angular_rad_s[1], &angular_rad_s[2], id) < 0 ||
         !inside(angular_rad_s, kFdTurnRadS))) {
        ++counts_.missing_velocities;
        angular_rad_s.setZero();
    }
    const Vec3 linear = tact_axes(linear_m_s), angular = tact_axes(angular_rad_s);
    for (int i = 0; i < 3; ++i) {
        sample_.linear_m_s[i] = linear[i];
        sample_.angular_rad_s[i] = angular[i];
    }
}

void Pump::take_buttons() noexcept {
    sample_.buttons = api_->dhdGetButtonMask(session_->id());
    if (!session_->gripper()) return;
    double angle_rad = 0.0;
    if (api_->dhdGetGripperAngleRad(&angle_rad, session_->id()) < 0 || !std::isfinite(angle_rad)) {
        gripped_ = false;
    } else {
        // The angle of a left-handed gripper opens to the negative side.
        const double open_rad = session_->left_handed() ? -angle_rad : angle_rad;
        gripped_ = open_rad < (gripped_ ? kGripperOpenRad : kGripperClosedRad);
    }
    if (gripped_) sample_.buttons |= 1U;
}

void Pump::take_status(Instant now) noexcept {
    std::array<int, kStatusRoom> status{};
    if (const int result = api_->dhdGetStatus(status.data(), session_->id()); result < 0)
        return check(result, now);
    const double rate_khz = api_->dhdGetComFreq(session_->id());
    const double period_ms = rate_khz > 0.2 && rate_khz < 20.0 ? 1.0 / rate_khz : 1.0;
    transport_ = Duration(std::llround(kTransportPeriods * period_ms * 1e6));
    if (status[kStatusConnected] == 0 || status[kStatusPower] == 0) return fail(FaultKind::link, now);
    if (!session_->initialized()) return fail(FaultKind::not_initialized, now);
    if (status[kStatusError] != 0) return fail(FaultKind::device, now);
    if (output_on_ && status[kStatusForce] == 0 && now - switched_at_ >= kSettle)
        fail(fault_of_force_off(status[kStatusForceOffCause]), now);
}

void Pump::apply(Instant now) noexcept {
    if (!mail_.fetch(command_)) return;
    gate_.apply(command_, now, true, !session_->is_open());
    counts_.watchdog_trips = gate_.trips();
}

void Pump::switch_output(bool on, Instant now) noexcept {
    if (on == output_on_) return;
    output_on_ = on;
    switched_at_ = now;
    const char id = session_->id();
    if (on) {
        static_cast<void>(api_->dhdSetBrakes(kOff, id));
        return check(api_->dhdEnableForce(kOn, id), now);
    }
    // Results do not matter here: the caller latches a fault, or the next round finds it.
    static_cast<void>(api_->dhdSetForceAndTorqueAndGripperForce(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, id));
    static_cast<void>(api_->dhdEnableForce(kOff, id));
    static_cast<void>(api_->dhdSetBrakes(kOn, id));
}

void Pump::send(Instant now) noexcept {
    Vec3 force_n = Vec3::Zero(), torque_n_m = Vec3::Zero();
    const bool on = gate_.state() == DeviceState::powered;
    if (on) {
        const Vec3 f = Eigen::Map<const Vec3>(command_.force_n),
                   t = Eigen::Map<const Vec3>(command_.torque_n_m);
        if (f.allFinite() && t.allFinite()) {
            const Model& m = session_->model();
            force_n = device_axes(shortened(f, m.force_n_max));
            if (session_->torque()) torque_n_m = device_axes(shortened(t, m.torque_n_m_max));
        } else {
            ++counts_.refused_commands;
        }
    }
    switch_output(on, now);
    if (!session_->is_open()) return;
    // Zero goes out too: it feeds the device's own watchdog, and the library measures its rate by forces.
    if (!output_on_) force_n = torque_n_m = Vec3::Zero();
    const int result =
        api_->dhdSetForceAndTorqueAndGripperForce(force_n.x(), force_n.y(), force_n.z(), torque_n_m.x(),
                                                  torque_n_m.y(), torque_n_m.z(), 0.0, session_->id());
    if (result == kMotorSaturated) ++counts_.saturated;
    check(result, now);
}

void Pump::publish() noexcept {
    const bool lost = !session_->is_open();
    sample_.state = static_cast<std::uint8_t>(gate_.state());
    sample_.ended = lost ? 1 : 0;
    const DeviceNotice notice = lost && waits_                        ? DeviceNotice::not_initialized
                                : lost                                ? DeviceNotice::gone
                                : gate_.state() == DeviceState::fault ? meaning(counts_.last_kind).notice
                                : gate_.state() == DeviceState::watchdog_tripped
                                    ? DeviceNotice::watchdog_tripped
                                    : DeviceNotice::none;
    sample_.notice = static_cast<std::uint8_t>(notice);
    const auto failed = [this](FaultKind kind) { return counts_.faults[static_cast<std::size_t>(kind)]; };
    sample_.bus.packets = saturated(sample_.sequence);
    sample_.bus.refused = saturated(counts_.refused_samples);
    sample_.bus.reconnects = saturated(counts_.reopened);
    sample_.bus.transfers_failed = saturated(failed(FaultKind::link));
    sample_.bus.commands_refused = saturated(failed(FaultKind::refused));
    if (sample_.sequence > 0) mail_.publish(sample_);
    published_->publish(counts_);
}

void Pump::finish() noexcept {
    if (session_->is_open()) switch_output(false, Instant{});
}

Counts Pump::counts() const noexcept {
    Counts c;
    static_cast<void>(published_->read(c));
    return c;
}

}  // namespace tact::fd
