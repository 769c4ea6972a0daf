#include "hal/vendor/servo_mail.hpp"

#include <algorithm>

namespace tact::vendor {

IoStatus ServoMail::read(DeviceSample& newest, Instant now) noexcept {
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

IoStatus ServoMail::write(const DeviceCommand& command) noexcept {
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

void ServoMail::relax() noexcept {
    low_seen_ = false;  // an enable that is still high is no edge
    ++relaxed_sent_;
    CommandWords w{};
    // A heartbeat outside the servo loop's range, so that relax() does not count as silence.
    w.heartbeat = ++heartbeat_sent_ | 1ULL << 63U;
    w.edge = edges_sent_;
    w.relaxed = relaxed_sent_;
    mailbox_->command.publish(w);
}

}  // namespace tact::vendor
