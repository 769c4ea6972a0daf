// Data of a Premium 1.5 with six degrees of freedom in and out, from the manufacturer: workspace 381 x 267
// x 191 mm, 8.5 N peak and 1.4 N continuous, 0.515 N m, 0.03 mm at the tip, 3.5 N/mm.
#include "hal/sim/sim_device.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "ipc/base/shortened.hpp"

namespace tact {

namespace {

constexpr double kTurnStepRad = 1e-4;
constexpr double kVelocityCutHz =
    30.0;  // of the driver's differentiator: one step of 0.03 mm must not give 30 mm/s

Vec3 stepped(const Vec3& v, double step) noexcept {
    return {std::round(v.x() / step) * step, std::round(v.y() / step) * step,
            std::round(v.z() / step) * step};
}

DeviceInfo premium() {
    DeviceInfo info;
    info.name = "emulated Phantom Premium 1.5, 6 degrees of freedom";
    info.serial = "sim";
    info.workspace_half_m = {0.1905, 0.1335, 0.0955};
    info.force_n_max = 8.5;
    info.force_n_continuous = 1.4;
    info.torque_n_m_max = 0.515;
    info.stiffness_n_m_max = 3500.0;
    info.position_step_m = 3e-5;
    return info;
}

}  // namespace

// The arm reaches slightly beyond the workspace stated by the manufacturer.
SimDevice::SimDevice(const SimSettings& settings)
    : settings_(settings), info_(premium()), hand_(settings.hand, 1.1 * info_.workspace_half_m) {}

DeviceInfo SimDevice::open() {
    state_ = DeviceState::ready;
    return info_;
}

void SimDevice::drop(DeviceState to) noexcept {
    shown_ = {};
    state_ = to;
}

void SimDevice::advance(Instant now) noexcept {
    if (!started_) {
        started_ = true;
        moved_at_ = fed_at_ = now;
    }
    if (now <= moved_at_) return;
    if (MouseTarget target; settings_.mouse != nullptr && settings_.mouse->read(target))
        hand_.follow(target, now);
    const Instant bites_at = fed_at_ + settings_.watchdog;
    if (state_ == DeviceState::powered && now > bites_at) {
        const Instant until = std::max(bites_at, moved_at_);
        hand_.step(until - moved_at_, shown_, true);
        moved_at_ = until;
        drop(DeviceState::watchdog_tripped);
    }
    hand_.step(now - moved_at_, shown_, state_ == DeviceState::powered);
    moved_at_ = now;
}

void SimDevice::sample(Instant now) noexcept {
    const Vec3 p = stepped(hand_.pose().p_m, info_.position_step_m);
    const Quat q = quat_from_rotation_vector(stepped(rotation_vector_rad(hand_.pose().q), kTurnStepRad));
    if (newest_.sequence > 0 && now > newest_.taken_at) {
        newest_.delay = now - newest_.taken_at;  // the command of one cycle moves the sample of the next
        const double dt_s = to_s(newest_.delay);
        const double share = 1.0 - std::exp(-2.0 * std::numbers::pi * kVelocityCutHz * dt_s);
        const Vec3 turned = rotation_vector_rad(q * newest_.T_dev_tool.q.conjugate());
        Twist& t = newest_.twist_dev;
        t.linear_m_s += share * ((p - newest_.T_dev_tool.p_m) / dt_s - t.linear_m_s);
        t.angular_rad_s += share * (turned / dt_s - t.angular_rad_s);
    }
    newest_.taken_at = now;
    ++newest_.sequence;
    newest_.T_dev_tool = {p, q};
    newest_.buttons = hand_.buttons();
}

IoStatus SimDevice::read(DeviceSample& newest, Instant now) noexcept {
    if (state_ == DeviceState::closed || fault_ == SimFault::unplugged) {
        advance(now);
        drop(DeviceState::closed);
        newest.notice = DeviceNotice::gone;
        return IoStatus::lost;
    }
    advance(now);
    if (fault_ == SimFault::amplifier) drop(DeviceState::fault);
    if (fault_ == SimFault::watchdog && state_ == DeviceState::powered) drop(DeviceState::watchdog_tripped);
    const bool frozen = fault_ == SimFault::frozen && newest_.sequence > 0;
    if (!frozen) sample(now);
    newest_.state = state_;
    newest_.hand_present = fault_ != SimFault::hand_off;
    newest = newest_;
    if (fault_ == SimFault::wild_pose) newest.T_dev_tool.p_m.x() = std::numeric_limits<double>::quiet_NaN();
    if (state_ == DeviceState::fault) return IoStatus::fault;
    return frozen ? IoStatus::stale : IoStatus::ok;
}

IoStatus SimDevice::write(const DeviceCommand& command, Instant now) noexcept {
    advance(now);
    if (state_ == DeviceState::closed || fault_ == SimFault::unplugged) {
        drop(DeviceState::closed);
        return IoStatus::lost;
    }
    if (fault_ == SimFault::none && state_ == DeviceState::fault) state_ = DeviceState::ready;
    if (command.heartbeat != heartbeat_) {
        heartbeat_ = command.heartbeat;
        fed_at_ = now;
    }
    const bool edge = command.enable && !enable_before_;
    enable_before_ = command.enable;
    if (state_ == DeviceState::fault) return IoStatus::fault;
    if (!command.enable) {
        drop(DeviceState::ready);
        return IoStatus::ok;
    }
    if (edge) state_ = DeviceState::powered;
    const bool shows = state_ == DeviceState::powered && command.wrench_dev.finite();
    shown_ = shows ? Wrench{shortened(command.wrench_dev.force_n, info_.force_n_max),
                            shortened(command.wrench_dev.torque_n_m, info_.torque_n_m_max)}
                   : Wrench{};
    return IoStatus::ok;
}

void SimDevice::relax() noexcept {
    enable_before_ = true;  // an enable that is still high is no edge
    if (state_ != DeviceState::closed) drop(DeviceState::ready);
}

}  // namespace tact
