// The stages of the output chain, each a pure function; output_chain.cpp calls them in order.
//
// Frame  device. Every stage maps a finite wrench to a finite one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/clock.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact::stages {

// Maximum time step of slew, ramp and gains, so that they do not jump after a pause of the machine.
inline constexpr Duration kStepMax = std::chrono::milliseconds(2);

// Spring force towards the box of half widths half_m - margin_m, axis by axis; zero inside it.
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

// Mean delay of a force behind its sample: half a period plus the delay from encoders to motors. An unknown delay counts
// as one period, which no loop falls below.
[[nodiscard]] inline double wait_s(double period_s, double delay_s) noexcept TACT_RT {
    return 0.5 * period_s + (delay_s > 0.0 ? delay_s : period_s);
}

// Largest stiffness that a sampled loop may render: K < b / (T/2 + t_d), with the damping b of hand and arm, the period T
// and the delay t_d from encoders to motors. Without delay this is the passivity condition of a sampled wall,
// b > K T/2 (Colgate, Schenkel 1997); with delay, the stability bound of Gil, Hulin et al. (2009).
[[nodiscard]] inline double stiffness_max_n_m(double damping_n_s_m, double period_s,
                                              double delay_s) noexcept TACT_RT {
    const double wait = wait_s(period_s, delay_s);
    return wait > 0.0 ? damping_n_s_m / wait : std::numeric_limits<double>::infinity();
}

// Largest damping that such a loop may render on a mass m: B < m / (T/2 + t_d); at pi/2 m / (T/2 + t_d) a damper with this
// delay oscillates by itself. It is not reduced with the stiffness: up to this bound the rendered damping adds to that of
// hand and arm (Gil, Hulin: K < (b + B) / (T/2 + t_d)), and is needed most when the field is reduced. The bound on
// stiffness does not rely on it.
[[nodiscard]] inline double damping_max_n_s_m(double mass_kg, double period_s,
                                              double delay_s) noexcept TACT_RT {
    const double wait = wait_s(period_s, delay_s);
    return wait > 0.0 ? mass_kg / wait : std::numeric_limits<double>::infinity();
}

// Limits the length to max; keeps the direction.
[[nodiscard]] inline Vec3 saturated(const Vec3& v, double max) noexcept TACT_RT {
    const double size = v.stableNorm();
    return size > max ? Vec3(v * (max / size)) : v;
}

// Limits the change from before to step. A smaller change passes bit-exact, so the caller can detect whether it acted.
[[nodiscard]] inline Vec3 slewed(const Vec3& before, const Vec3& wanted, double step) noexcept TACT_RT {
    const Vec3 change = wanted - before;
    const double size = change.stableNorm();
    return size > step ? Vec3(before + change * (step / size)) : wanted;
}

// Gain in [0, 1] that moves towards 1 (up) or 0; in_s, out_s: seconds for the full range.
[[nodiscard]] inline double ramped(double gain, bool up, double dt_s, double in_s,
                                   double out_s) noexcept TACT_RT {
    const double step = up ? dt_s / std::max(in_s, 1e-6) : -dt_s / std::max(out_s, 1e-6);
    return std::clamp(gain + step, 0.0, 1.0);
}

// Heat of the motors relative to their continuous limit: theta follows (F / F_continuous)^2 with time constant tau. Exact
// for a constant force at any step.
[[nodiscard]] inline double heated(double theta, double force_n, double continuous_n, double tau_s,
                                   double dt_s) noexcept TACT_RT {
    if (continuous_n <= 0.0 || tau_s <= 0.0) return 0.0;
    const double load = (force_n / continuous_n) * (force_n / continuous_n);
    return load + (theta - load) * std::exp(-dt_s / tau_s);
}

// Force limit at a heat: the full range up to theta = 0.8, the continuous force from theta = 1, linear in between, so that
// a warm motor weakens gradually.
[[nodiscard]] inline double heat_limit_n(double theta, double max_n, double continuous_n) noexcept TACT_RT {
    if (continuous_n <= 0.0 || continuous_n >= max_n) return max_n;
    const double warm = std::clamp((theta - 0.8) / 0.2, 0.0, 1.0);
    return max_n + warm * (continuous_n - max_n);
}

}  // namespace tact::stages
