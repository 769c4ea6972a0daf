// The twist is that of the filtered pose: with a cut-off f, tau = 1/(2 pi f), the filtered value is x^ = x
// - tau v^, with v^ its own derivative, so x^ + h v^ compensates h of the lag tau, and a prediction at rest
// has no more noise than the filter. A derivative of the raw pose with its own cut-off has either more lag
// or more noise.
#include "hal/tracker/head_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {

namespace {

double share(double cutoff_hz, double dt_s) noexcept {
    return 1.0 - std::exp(-2.0 * std::numbers::pi * cutoff_hz * dt_s);
}

// Moves the steering speed towards the speed of the last step and returns the weight of the new sample.
double steered(const OneEuroSettings& s, const Vec3& step, double dt_s, Vec3& speed) noexcept {
    speed += share(s.speed_cutoff_hz, dt_s) * (step / dt_s - speed);
    return share(s.min_cutoff_hz + s.beta_hz_per_speed * speed.norm(), dt_s);
}

}  // namespace

void HeadFilter::add(Instant taken_at, const Pose& pose) noexcept {
    const Duration step = taken_at - taken_at_;
    if (!known_ || step > kGap) {
        known_ = true;
        taken_at_ = taken_at;
        raw_ = filtered_ = pose;
        steering_ = twist_ = {};
        return;
    }
    if (step <= Duration{0}) return;
    const double dt_s = to_s(step);
    const double move = steered(settings_.position, pose.p_m - raw_.p_m, dt_s, steering_.linear_m_s);
    const Vec3 way = move * (pose.p_m - filtered_.p_m);
    const double turn = steered(settings_.rotation, rotation_vector_rad(pose.q * raw_.q.conjugate()), dt_s,
                                steering_.angular_rad_s);
    const Vec3 arc = turn * rotation_vector_rad(pose.q * filtered_.q.conjugate());
    filtered_.p_m += way;
    filtered_.q = (quat_from_rotation_vector(arc) * filtered_.q).normalized();
    twist_ = {way / dt_s, arc / dt_s};
    raw_ = pose;
    taken_at_ = taken_at;
}

Pose HeadFilter::at(Instant when) const noexcept {
    const double ahead_s = to_s(std::clamp(when - taken_at_, Duration{0}, kHorizon));
    return {filtered_.p_m + ahead_s * twist_.linear_m_s,
            (quat_from_rotation_vector(ahead_s * twist_.angular_rad_s) * filtered_.q).normalized()};
}

}  // namespace tact
