#include "rt/force/surface/contact_force.hpp"

#include <cmath>

namespace tact {
namespace {

constexpr double kUnpacedM = 1e9;
constexpr int kPaceAttempts = 10;
// The next step may go this much farther along the force, in displacements of this one.
constexpr double kFarther = 0.3;

}  // namespace

template <class Vec>
void ContactForceOf<Vec>::reset() noexcept {
    push_m_.setZero();
    way_m_.setZero();
    shown_n_.setZero();
    account_j_ = spring_m_ = gain_ = off_n_ = 0.0;
}

// Push plus rub, with the rub turned across the push and limited by the coefficient of friction.
template <class Vec>
Vec ContactForceOf<Vec>::in_cone_m(const Vec& push_m, const Vec& rub_m) const noexcept {
    const double push = push_m.norm();
    if (!(push > 0.0) || settings_.friction <= 0.0) return push_m;
    const Vec across = rub_m - push_m.dot(rub_m) / (push * push) * push_m;
    const double length = across.norm(), most = std::min(settings_.friction * push, rub_m.norm());
    return length > 0.0 ? Vec(push_m + most / length * across) : push_m;
}

// Of a spring that is pressed by way_m and yields at the force limit.
template <class Vec>
double ContactForceOf<Vec>::spring_j(double way_m) const noexcept {
    const double k = settings_.stiffness_n_m, most = settings_.force_n_max;
    return k * way_m <= most ? 0.5 * k * way_m * way_m : most * (way_m - 0.5 * most / k);
}

template <class Vec>
void ContactForceOf<Vec>::pace(const Vec& push_m, const Vec& way_m, double most_m) noexcept {
    const Vec push_before_m = push_m_, before_m = way_m_;
    const double change = (way_m - before_m).norm();
    double share = change > most_m ? most_m / change : 1.0;
    // Back in the cone, the change may be a little longer.
    for (int attempt = 0; attempt < kPaceAttempts; ++attempt, share *= 0.7) {
        push_m_ = push_before_m + share * (push_m - push_before_m);
        const Vec blend_m = before_m + share * (way_m - before_m);
        way_m_ = share < 1.0 ? in_cone_m(push_m_, blend_m - push_m_) : way_m;
        if (share >= 1.0 || (way_m_ - before_m).norm() <= most_m) return;
    }
    push_m_ = push_before_m;
    way_m_ = before_m;
}

template <class Vec>
Vec ContactForceOf<Vec>::step(const Input& in) noexcept {
    const ContactForceSettings& s = settings_;
    account_j_ -= 0.5 * shown_n_.dot(in.moved_m);
    const double most_m = gain_ > 0.0 ? kForceSteps * in.moved_m.norm() + 2.0 * s.lag_m : kUnpacedM;
    const Vec full_push_m = in.lift_m + in.turn_m, full_way_m = in_cone_m(full_push_m, in.rub_m);
    if (!(gain_ > 0.0)) spring_m_ = full_way_m.norm();
    account_j_ += (in.gain - gain_) * spring_j(spring_m_);  // a fade is no work of the hand
    gain_ = in.gain;
    spring_m_ += std::clamp(full_way_m.norm() - spring_m_, -most_m, most_m);
    const double held_j = in.gain * spring_j(spring_m_),
                 given_j = 0.5 * in.gain * s.stiffness_n_m * full_way_m.dot(in.moved_m),
                 ratio = (account_j_ - given_j + kOpenJ) / (held_j + kOpenJ);
    const double shaded = std::clamp((ratio - kShadedTo) / (kShadedFrom - kShadedTo), 0.0, 1.0),
                 scale = std::clamp(ratio / kShadedTo, 0.0, 1.0);
    if (shaded < 1.0) {
        const Vec push_m = scale * (in.lift_m + shaded * in.turn_m);
        pace(push_m, in_cone_m(push_m, scale * in.rub_m), most_m);
    } else {
        pace(full_push_m, full_way_m, most_m);
    }

    const double depth_m = way_m_.norm(), full_m = full_way_m.norm();
    const Vec normal = depth_m > 0.0 ? Vec(way_m_ / depth_m) : Vec(Vec::Zero());
    const double into_m_s = in.velocity_m_s.allFinite() ? -normal.dot(in.velocity_m_s) : 0.0;
    const double damped = s.damping_n_s_m * into_m_s * std::min(1.0, depth_m / s.damped_depth_m);
    const auto limited_n = [&](double way_m) {
        return in.gain * std::clamp(s.stiffness_n_m * way_m + damped, 0.0, s.force_n_max);
    };
    Vec force_n = limited_n(depth_m) * normal;
    // The next step may leave the surface: then this force works along one more displacement.
    const double along_j = force_n.dot(in.moved_m),
                 next_j = std::max(along_j + kFarther * force_n.norm() * in.moved_m.norm(), 0.0),
                 leaving_j = 0.5 * (along_j + next_j), left_j = std::max(account_j_ + kOpenJ, 0.0);
    if (leaving_j > left_j) force_n *= left_j / leaving_j;
    off_n_ = (force_n - (full_m > 0.0 ? limited_n(full_m) / full_m : 0.0) * full_way_m).norm();
    // A force that fades is still an excursion.
    account_j_ -= 0.5 * force_n.dot(in.moved_m);
    const double kept_j =
        kKeptShares * in.gain * spring_j(std::max(spring_m_, depth_m)) + force_n.norm() * in.moved_m.norm();
    account_j_ = depth_m > 0.0 || full_m > 0.0 ? std::min(account_j_, kept_j) : 0.0;
    shown_n_ = force_n;
    return force_n;
}

template class ContactForceOf<Vec3>;
template class ContactForceOf<Vec6>;

}  // namespace tact
