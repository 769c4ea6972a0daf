#include "gui/stereo/head_view.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr std::uint8_t kHeadFresh =
    2;  // TrackerState of the hardware layer, which this process does not include

Pose moved_on(const HeadTopic& h, std::int64_t display_ns) {
    const double ahead_s = 1e-9 * static_cast<double>(std::clamp(display_ns - h.taken_at_ns, std::int64_t{0},
                                                                 HeadView::kHorizonNs));
    const Vec3 way_m = ahead_s *
                       Vec3(h.velocity_screen_m_s[0], h.velocity_screen_m_s[1], h.velocity_screen_m_s[2]),
               turn_rad = ahead_s * Vec3(h.angular_screen_rad_s[0], h.angular_screen_rad_s[1],
                                         h.angular_screen_rad_s[2]);
    const double* const q = h.quat_screen_head_xyzw;
    return {Vec3(h.pos_screen_m[0], h.pos_screen_m[1], h.pos_screen_m[2]) + way_m,
            (quat_from_rotation_vector(turn_rad) * Quat(q[3], q[0], q[1], q[2])).normalized()};
}

}  // namespace

const Pose& HeadView::follow(const HeadTopic* head, std::int64_t now_ns, std::int64_t display_ns) {
    const bool seen = head != nullptr && head->sequence > 0 && head->state == kHeadFresh &&
                      now_ns - head->taken_at_ns <= kHorizonNs;
    const HeadSight before = sight_;
    if (seen) {
        aim_ = moved_on(*head, display_ns);
        sight_ = HeadSight::seen;
    } else if (sight_ == HeadSight::seen || (head != nullptr && head->sequence > 0)) {
        sight_ = HeadSight::lost;  // the aim stays at the last pose shown, without extrapolation
        if (before == HeadSight::seen) aim_ = shown_;
    }
    if (sight_ != before) {  // continue from the pose shown
        off_.p_m = shown_.p_m - aim_.p_m;
        off_.q = shown_.q * aim_.q.conjugate();
    }
    const double passed_s =
        now_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(std::max(now_ns - now_ns_, std::int64_t{0}));
    now_ns_ = now_ns;
    const double left = std::exp(-passed_s / kSmoothS);
    off_.p_m *= left;
    off_.q = Quat::Identity().slerp(left, off_.q).normalized();
    shown_ = {aim_.p_m + off_.p_m, (off_.q * aim_.q).normalized()};
    return shown_;
}

}  // namespace tact
