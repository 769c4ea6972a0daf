#include "hal/sim/mouse_hand.hpp"

#include <algorithm>

#include "ipc/base/shortened.hpp"

namespace tact {

void MouseHand::follow(const MouseTarget& target, Instant now, const Pose& hand,
                       const Twist& motion) noexcept {
    const Duration age = now - instant_from_ns(target.arrived_ns);
    const bool leads = target.holds != 0 && age <= kStaleAfter && age >= -kStaleAfter;
    if (leads && !leads_) {
        target_ = hand;
        motion_ = {shortened(motion.linear_m_s, kSpeedMost), shortened(motion.angular_rad_s, kTurnMost)};
    }
    leads_ = leads;
    if (!leads) return;
    taken_ = true;
    buttons_ = target.buttons;
    for (int i = 0; i < 3; ++i) goal_.p_m[i] = std::clamp(target.pos_dev_m[i], -reach_m_[i], reach_m_[i]);
    for (int i = 0; i < 4; ++i) goal_.q.coeffs()[i] = target.quat_dev_tool_xyzw[i];
}

void MouseHand::step(double h_s) noexcept {
    const auto filter = [h_s](const Vec3& away, Vec3& rate, double most) {
        const Vec3 seen = shortened(away, 2.0 * most / kResponse);
        rate += h_s * (kResponse * kResponse * seen - 2.0 * kResponse * rate);
        return Vec3(h_s * rate);
    };
    target_.p_m += filter(goal_.p_m - target_.p_m, motion_.linear_m_s, kSpeedMost);
    const Vec3 away = rotation_vector_rad(goal_.q * target_.q.conjugate());
    const Vec3 turn = filter(away, motion_.angular_rad_s, kTurnMost);
    target_.q = (quat_from_rotation_vector(turn) * target_.q).normalized();
}

Wrench MouseHand::pull(const Pose& hand, const Twist& motion) const noexcept {
    const Vec3 force =
        kStiffness * (target_.p_m - hand.p_m) + kDamping * (motion_.linear_m_s - motion.linear_m_s);
    const Vec3 torque = kTurnStiffness * rotation_vector_rad(target_.q * hand.q.conjugate());
    return {shortened(force, kForceMost), shortened(torque, kTorqueMost)};
}

}  // namespace tact
