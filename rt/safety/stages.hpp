// The stages of the output chain, each a small function of its inputs; output_chain.cpp puts them in order.
//
// Frame  device. Every stage takes a finite wrench and gives a finite one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact::stages {

// A pause of the machine must not become a leap of what moves with time (slew, ramp, gains): one cycle moves them
// by no more than two milliseconds' worth.
inline constexpr Duration kStepMax = std::chrono::milliseconds(2);

// Zero in place of a wrench with any component that is not finite.
[[nodiscard]] inline Wrench finite_or_zero(const Wrench& w) noexcept TACT_RT {
    return w.finite() ? w : Wrench{};
}

// Spring back into the box of half widths half_m - margin_m, axis by axis; nothing inside it.
[[nodiscard]] inline Vec3 wall_force_n(const Vec3& p_m, const Vec3& half_m, double margin_m,
                                       double stiffness_n_m) noexcept TACT_RT {
    Vec3 force = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        const double edge = std::max(half_m[i] - margin_m, 0.0);
        const double depth = std::abs(p_m[i]) - edge;
        if (depth > 0.0) force[i] = -std::copysign(stiffness_n_m * depth, p_m[i]);
    }
    return force;
}

// How old, on average, the sample is that a force answers: half a period and the delay from the encoders to the
// motors. A delay that nobody knows is a period: no loop has less than that from one sample to the next.
[[nodiscard]] inline double wait_s(double period_s, double delay_s) noexcept TACT_RT {
    return 0.5 * period_s + (delay_s > 0.0 ? delay_s : period_s);
}

// Largest stiffness that a sampled loop may render: K < b / (T/2 + t_d), with the damping b of hand and arm,
// the period T and the delay t_d from the encoders to the motors. Without a delay it is Colgate and
// Schenkel's passivity of a sampled wall, b > K T/2 (1997); with it, Gil, Hulin and others' bound of stability
// (2009).
[[nodiscard]] inline double stiffness_max_n_m(double damping_n_s_m, double period_s,
                                              double delay_s) noexcept TACT_RT {
    const double wait = wait_s(period_s, delay_s);
    return wait > 0.0 ? damping_n_s_m / wait : std::numeric_limits<double>::infinity();
}

// Largest damping that such a loop may render to a mass m: B < m / (T/2 + t_d), of the pi/2 m / (T/2 + t_d) at
// which a damper that comes so late swings by itself. It does not follow the stiffness: up to here what is
// rendered adds to the damping of hand and arm (Gil, Hulin: K < (b + B) / (T/2 + t_d)), so that to take it
// away with the field would take it where it is needed most. The bound on stiffness does not count on it.
[[nodiscard]] inline double damping_max_n_s_m(double mass_kg, double period_s,
                                              double delay_s) noexcept TACT_RT {
    const double wait = wait_s(period_s, delay_s);
    return wait > 0.0 ? mass_kg / wait : std::numeric_limits<double>::infinity();
}

// Shortened to max, direction kept.
[[nodiscard]] inline Vec3 saturated(const Vec3& v, double max) noexcept TACT_RT {
    const double size = v.stableNorm();
    return size > max ? Vec3(v * (max / size)) : v;
}

// At most step away from before. What is nearer passes bit for bit, so that a caller can tell whether it
// acted.
[[nodiscard]] inline Vec3 slewed(const Vec3& before, const Vec3& wanted, double step) noexcept TACT_RT {
    const Vec3 change = wanted - before;
    const double size = change.stableNorm();
    return size > step ? Vec3(before + change * (step / size)) : wanted;
}

// Gain in [0, 1] moving towards its target in so many seconds for the whole way.
[[nodiscard]] inline double ramped(double gain, bool up, double dt_s, double in_s,
                                   double out_s) noexcept TACT_RT {
    const double step = up ? dt_s / std::max(in_s, 1e-6) : -dt_s / std::max(out_s, 1e-6);
    return std::clamp(gain + step, 0.0, 1.0);
}

// Heat of the motors relative to what they stand for ever: theta follows (F / F_continuous)^2 with time
// constant tau. Exact for a constant force, whatever the step.
[[nodiscard]] inline double heated(double theta, double force_n, double continuous_n, double tau_s,
                                   double dt_s) noexcept TACT_RT {
    if (continuous_n <= 0.0 || tau_s <= 0.0) return 0.0;
    const double load = (force_n / continuous_n) * (force_n / continuous_n);
    return load + (theta - load) * std::exp(-dt_s / tau_s);
}

// Largest force at that heat: the whole range while cool, the continuous force from theta = 1 on, between
// them a straight line from theta = 0.8, so that a warm motor weakens gradually and is not cut.
[[nodiscard]] inline double heat_limit_n(double theta, double max_n, double continuous_n) noexcept TACT_RT {
    if (continuous_n <= 0.0 || continuous_n >= max_n) return max_n;
    const double warm = std::clamp((theta - 0.8) / 0.2, 0.0, 1.0);
    return max_n + warm * (continuous_n - max_n);
}

}  // namespace tact::stages
