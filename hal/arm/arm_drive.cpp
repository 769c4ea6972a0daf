// With currents c = g + s r, g for the weight and r for the wrench, the largest s with |c_i| <= L_i for all i is
//     s = min over i of (L_i - g_i sign r_i) / |r_i|,   clamped to [0, 1].
// The output wrench is s times the requested one, since tau = J^T w is linear in w.
#include "hal/arm/arm_drive.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/shortened.hpp"

namespace tact {

namespace {

// Each joint of the gimbal has its own limit; the whole torque is scaled down until all limits hold.
double torque_share(const Joint6& tau, const Vec3& max) noexcept {
    double share = 1.0;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const double size = std::abs(tau[3 + i]);
        if (size > max[i]) share = std::min(share, max[i] / size);
    }
    return share;
}

}  // namespace

DriveCurrents drive_currents(const ArmKinematics& arm, const Joint6& q, const Wrench& wrench_dev,
                             const Joint6& hold_n_m, const Joint6& limit_a) noexcept {
    DriveCurrents out;
    if (!q.allFinite() || !wrench_dev.finite() || !hold_n_m.allFinite() || !limit_a.allFinite()) return out;
    const ArmParameters& p = arm.parameters();
    out.valid = true;
    Wrench held = wrench_dev;
    held.force_n = shortened(wrench_dev.force_n, p.force_n_max);
    double share = held.force_n == wrench_dev.force_n ? 1.0 : p.force_n_max / wrench_dev.force_n.stableNorm();
    if (p.wrist == Wrist::driven) {
        // One factor scales force and torque, since the hand feels them together.
        const Joint6 turn = arm.torque_n_m(q, {Vec3::Zero(), wrench_dev.torque_n_m});
        share = std::min(share, torque_share(turn, p.torque_n_m_max));
    }
    held = {wrench_dev.force_n * share, wrench_dev.torque_n_m * share};
    const Joint6 tau = arm.torque_n_m(q, held);
    Joint6 hold_a = Joint6::Zero(), wrench_a = Joint6::Zero();
    double shown = 1.0;
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double n_m_per_a = p.joint_n_m_per_a[i];
        if (n_m_per_a == 0.0) continue;
        const double limit = std::clamp(limit_a[i], 0.0, p.current_a_max[i]);
        const double needed = hold_n_m[i] / n_m_per_a;
        hold_a[i] = std::clamp(needed, -limit, limit);
        if (std::abs(needed) > limit) shown = 0.0;
        wrench_a[i] = tau[i] / n_m_per_a;
        const double room = limit - std::copysign(hold_a[i], hold_a[i] * wrench_a[i]);
        if (std::abs(wrench_a[i]) > room) shown = std::min(shown, room / std::abs(wrench_a[i]));
    }
    shown = std::max(shown, 0.0);
    out.current_a = hold_a + shown * wrench_a;
    for (Eigen::Index i = 0; i < 6; ++i) {  // rounding errors
        const double limit = std::clamp(limit_a[i], 0.0, p.current_a_max[i]);
        out.current_a[i] = std::clamp(out.current_a[i], -limit, limit);
    }
    out.share = share * shown;
    return out;
}

}  // namespace tact
