#include "gui/link/pose_predictor.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

void PosePredictor::add(std::int64_t taken_at_ns, const Pose& pose) {
    if (known_ && taken_at_ns == taken_at_ns_) return;
    const std::int64_t gap_ns = taken_at_ns - taken_at_ns_;
    if (known_ && gap_ns > 0 && gap_ns < kGap_ns) {
        const double dt = 1e-9 * static_cast<double>(gap_ns);
        const Vec3 speed = (pose.p_m - pose_.p_m) / dt;
        const Vec3 spin = rotation_vector_rad(pose.q * pose_.q.conjugate()) / dt;
        const double share = 1.0 - std::exp(-dt / kSmooth_s);
        speed_m_s_ += share * (speed - speed_m_s_);
        spin_rad_s_ += share * (spin - spin_rad_s_);
    } else {
        speed_m_s_.setZero();
        spin_rad_s_.setZero();
    }
    known_ = true;
    taken_at_ns_ = taken_at_ns;
    pose_ = pose;
}

Pose PosePredictor::at(std::int64_t now_ns) const {
    const std::int64_t age_ns = now_ns - taken_at_ns_;
    if (!known_ || age_ns <= 0 || age_ns > kGap_ns) return pose_;
    const double dt = 1e-9 * static_cast<double>(std::min(age_ns, kHorizon_ns));
    return {pose_.p_m + dt * speed_m_s_,
            (quat_from_rotation_vector(dt * spin_rad_s_) * pose_.q).normalized()};
}

}  // namespace tact
