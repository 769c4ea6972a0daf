// Thermal model of a brushed motor with two bodies, winding and housing, and the current limit that
// follows.
//
// It is in ipc/base because the safety layer (rt), the drivers and the emulated amplifier (hal) share it
// and may not include each other.
//
//   C_w dT_w/dt = i^2 R (1 + a (T_w - 25)) - (T_w - T_h) / R_wh,      C_w = tau_w / R_wh, a of copper
//   C_h dT_h/dt = (T_w - T_h) / R_wh - (T_h - T_a) / R_ha,            C_h = tau_h / R_ha
//
// Step   exact for a current that is constant over the step, so any step is stable
// State  two temperatures, plain data; can be kept over a restart
#pragma once

#include <algorithm>
#include <cmath>

#include "ipc/base/rt.hpp"

namespace tact {

struct MotorHeatParameters {
    double resistance_ohm = 0.0;  // of the winding at 25 degrees C
    double winding_k_w = 0.0;     // thermal resistance winding to housing
    double housing_k_w = 0.0;     // thermal resistance housing to ambient
    double winding_tau_s = 0.0;   // winding against housing
    double housing_tau_s = 0.0;   // housing against ambient
    double winding_c_max = 0.0;   // highest permitted winding temperature
    double ambient_c = 25.0;
};

struct MotorHeat {
    double winding_c = 25.0;
    double housing_c = 25.0;
};

inline constexpr double kCopperPerK = 0.0039;  // relative rise of its resistance per K
inline constexpr double kHeatCMax = 1000.0;    // keeps states finite for any current

// The state after dt_s at that current. With x = (T_w, T_h): dx/dt = M x + c, so x(t) = x0 + t phi(M t) (M
// x0 + c) with phi(z) = (e^z - 1) / z, evaluated by Sylvester's formula. Both eigenvalues are real and
// differ, as the off-diagonal elements are positive. At a current beyond 1 / sqrt(a R (R_wh + R_ha)) one is
// positive: thermal runaway, limited by the bound above.
[[nodiscard]] inline MotorHeat heated(const MotorHeatParameters& f, const MotorHeat& before, double current_a,
                                      double dt_s) noexcept TACT_RT {
    if (!(dt_s > 0.0) || !std::isfinite(current_a)) return before;
    const double cold_w = std::min(current_a * current_a, 1e6) * f.resistance_ohm;
    const double winding_j_k = f.winding_tau_s / f.winding_k_w, housing_j_k = f.housing_tau_s / f.housing_k_w;
    const double m00 = (cold_w * kCopperPerK - 1.0 / f.winding_k_w) / winding_j_k;
    const double m01 = 1.0 / (f.winding_k_w * winding_j_k), m10 = 1.0 / (f.winding_k_w * housing_j_k);
    const double m11 = -(1.0 / f.winding_k_w + 1.0 / f.housing_k_w) / housing_j_k;
    const double c0 = cold_w * (1.0 - 25.0 * kCopperPerK) / winding_j_k;
    const double c1 = f.ambient_c / (f.housing_k_w * housing_j_k);
    const double r0 = m00 * before.winding_c + m01 * before.housing_c + c0;
    const double r1 = m10 * before.winding_c + m11 * before.housing_c + c1;
    const double mean = 0.5 * (m00 + m11), half = std::hypot(0.5 * (m00 - m11), std::sqrt(m01 * m10));
    const auto phi = [dt_s](double rate) {
        const double z = std::min(rate * dt_s, 50.0);
        return std::abs(z) < 1e-8 ? 1.0 + 0.5 * z : std::expm1(z) / z;
    };
    const double high = phi(mean + half), low = phi(mean - half);
    // f(M) r = (f(l1) + f(l2)) / 2 r + (f(l1) - f(l2)) / (2 half) (M - mean) r
    const double even = 0.5 * (high + low) * dt_s, odd = 0.5 * (high - low) / half * dt_s;
    const auto bounded = [&f](double c) { return std::clamp(c, std::min(f.ambient_c, 0.0), kHeatCMax); };
    return {bounded(before.winding_c + even * r0 + odd * ((m00 - mean) * r0 + m01 * r1)),
            bounded(before.housing_c + even * r1 + odd * (m10 * r0 + (m11 - mean) * r1))};
}

// The current whose steady-state winding temperature is exactly the limit.
[[nodiscard]] inline double continuous_current_a(const MotorHeatParameters& f) noexcept TACT_RT {
    const double rise_k = f.winding_c_max - f.ambient_c;
    if (rise_k <= 0.0) return 0.0;
    const double hot_ohm = f.resistance_ohm * (1.0 + kCopperPerK * (f.winding_c_max - 25.0));
    return std::sqrt(rise_k / (hot_ohm * (f.winding_k_w + f.housing_k_w)));
}

// Largest current at that temperature: max_a while the winding is cool, falling from 80 % of its rise to
// the continuous current at the limit, so that a warm motor weakens gradually; zero from 10 K above it.
[[nodiscard]] inline double current_limit_a(const MotorHeatParameters& f, const MotorHeat& heat,
                                            double max_a) noexcept TACT_RT {
    const double rise_k = f.winding_c_max - f.ambient_c;
    if (rise_k <= 0.0) return 0.0;
    const double continuous_a = std::min(continuous_current_a(f), max_a);
    const double share = (heat.winding_c - f.ambient_c) / rise_k;
    const double warm = std::clamp((share - 0.8) / 0.2, 0.0, 1.0);
    const double over = std::clamp((heat.winding_c - f.winding_c_max) / 10.0, 0.0, 1.0);
    return (max_a + warm * (continuous_a - max_a)) * (1.0 - over);
}

}  // namespace tact
